//! A folder in LeRobot's layout: `meta/info.json` and Parquet files in `data/`. The files on disk and their column
//! `episode_index` are authoritative, not the version that the folder states.

use std::collections::{BTreeSet, HashMap};
use std::fs;
use std::path::{Path, PathBuf};

use crate::input::{Input, name_of, unreadable};
use crate::joined::joined;
use crate::names::natural;
use crate::raw::RawRecordings;
use crate::regular_file::read_bytes;
use crate::rows::json::Json;
use crate::rows::parquet::{self, Described, STATE};
use crate::{Fault, ReadError, ReadOptions};

/// Maximum size in bytes of a file of `meta/`.
const META: u64 = 256 << 20;

pub(crate) fn read(
    path: &Path,
    options: &ReadOptions,
    progress: &mut dyn FnMut(u64),
) -> Result<RawRecordings, ReadError> {
    let name = name_of(path);
    let info = Info::read(path, &name)?;
    let described = Described { elements: info.elements(), period: info.period };
    let mut files = parquet_files(&path.join("data"), &name)?;
    files.sort_by(|a, b| natural::compare(&a.to_string_lossy(), &b.to_string_lossy()));
    let joined = joined(&files, |file| parquet::read(&Input::new(file, options)?, &described, progress))?;
    let recordings = joined.ok_or_else(|| {
        let remedy = "hf download REPOSITORY --repo-type dataset";
        ReadError::MissingFile(Fault::new("there is no Parquet file in data/", &name, remedy))
    })?;
    if options.episode.is_none() {
        info.refuse_missing(path, &name, &recordings)?;
    }
    Ok(recordings)
}

/// `meta/info.json`.
struct Info {
    json: Json,
    period: Option<f64>,
}

impl Info {
    fn read(path: &Path, name: &str) -> Result<Self, ReadError> {
        let place = format!("{name}, meta/info.json");
        let text = read_bytes(&path.join("meta/info.json"), META).map_err(|error| unreadable(&error, &place))?;
        let json: Json = serde_json::from_slice(&text).map_err(|error| {
            ReadError::Json(Fault::new(format!("this is not JSON: {error}"), &place, "another copy of the folder"))
        })?;
        let period =
            json.get("fps").and_then(Json::number).map(|fps| 1.0 / fps).filter(|dt| dt.is_finite() && *dt > 0.0);
        Ok(Self { json, period })
    }

    /// Names of the elements of each feature: a list, several named lists, or none.
    fn elements(&self) -> HashMap<String, Vec<String>> {
        let Some(Json::Map(features)) = self.json.get("features") else { return HashMap::new() };
        let names = |feature: &Json| -> Option<Vec<String>> {
            let lists: Vec<&[Json]> = match feature.get("names")? {
                Json::List(names) => vec![names],
                Json::Map(groups) => groups.iter().filter_map(|(_, names)| names.list()).collect(),
                _ => return None,
            };
            let names: Option<Vec<String>> = lists.concat().iter().map(|name| name.text().map(str::to_owned)).collect();
            let length = feature.get("shape").and_then(Json::list).and_then(|shape| shape.first()?.number());
            names.filter(|names| length == Some(names.len() as f64))
        };
        // Goals have the same names as positions, so that only the state gets them.
        let state = features.iter().filter(|(feature, _)| feature == STATE);
        state.filter_map(|(feature, described)| Some((feature.clone(), names(described)?))).collect()
    }

    /// Refuses a folder that lacks episodes that `meta/` lists.
    fn refuse_missing(&self, path: &Path, name: &str, recordings: &RawRecordings) -> Result<(), ReadError> {
        let found: BTreeSet<&str> = recordings.episodes.iter().map(|raw| &raw.name[..]).collect();
        let listed = read_bytes(&path.join("meta/episodes.jsonl"), META).unwrap_or_default();
        let listed = String::from_utf8(listed).unwrap_or_default();
        let mut expected: Vec<u64> = listed
            .lines()
            .filter_map(|line| serde_json::from_str::<Json>(line).ok()?.get("episode_index")?.number())
            .map(|index| index as u64)
            .collect();
        if expected.is_empty() {
            let total = self.json.get("total_episodes").and_then(Json::number).unwrap_or(0.0) as u64;
            expected = (0..total.min(crate::raw::MOST_EPISODES as u64)).collect();
        }
        let Some(missing) = expected.into_iter().find(|index| !found.contains(&index.to_string()[..])) else {
            return Ok(());
        };
        let what = format!("episode {missing} is listed in meta/ but not on disk");
        let place = format!("{name}, {}", self.file_of(missing));
        let remedy = "hf download REPOSITORY --repo-type dataset (and git lfs pull)";
        Err(ReadError::MissingFile(Fault::new(what, place, remedy)))
    }

    /// The expected file of an episode; the pattern itself if files hold several.
    fn file_of(&self, episode: u64) -> String {
        let pattern = self.json.get("data_path").and_then(Json::text).unwrap_or("data/");
        let size = self.json.get("chunks_size").and_then(Json::number).filter(|&size| size >= 1.0).unwrap_or(1000.0);
        let chunk = episode / size as u64;
        pattern
            .replace("{episode_chunk:03d}", &format!("{chunk:03}"))
            .replace("{episode_index:06d}", &format!("{episode:06}"))
    }
}

/// The Parquet files in a folder and its subfolders.
fn parquet_files(folder: &Path, name: &str) -> Result<Vec<PathBuf>, ReadError> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).map_err(|error| unreadable(&error, &format!("{name}, data")))? {
        let path = entry.map_err(|error| unreadable(&error, name))?.path();
        if path.is_dir() {
            files.extend(parquet_files(&path, name)?);
        } else if path.extension().is_some_and(|extension| extension == "parquet") {
            files.push(path);
        }
    }
    Ok(files)
}
