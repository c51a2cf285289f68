//! Agreement with the reference traces in `golden/` (see the README there).

use std::path::Path;

use lwpr::{Kernel, LwprParams, Metric, MetricAdaptation};
use nalgebra::{DMatrix, DVector};
use serde_json::Value;

const TOLERANCE: f64 = 1e-10;

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn vector(value: &Value) -> DVector<f64> {
    DVector::from_iterator(value.as_array().unwrap().len(), value.as_array().unwrap().iter().map(number))
}

/// Rows of the file become columns.
fn samples(value: &Value) -> DMatrix<f64> {
    DMatrix::from_columns(&value.as_array().unwrap().iter().map(vector).collect::<Vec<_>>())
}

fn params(file: &Value) -> LwprParams {
    let p = &file["params"];
    LwprParams {
        init_d: number(&p["init_D_diagonal"]),
        init_alpha: number(&p["init_alpha"]),
        metric: if p["diag_only"].as_bool().unwrap() { Metric::Diagonal } else { Metric::Full },
        adaptation: match (p["update_D"].as_bool().unwrap(), p["meta"].as_bool().unwrap()) {
            (false, _) => MetricAdaptation::Fixed,
            (true, false) => MetricAdaptation::Gradient,
            (true, true) => MetricAdaptation::Meta { rate: number(&p["meta_rate"]) },
        },
        kernel: if p["kernel"] == "gaussian" { Kernel::Gaussian } else { Kernel::BiSquare },
        penalty: number(&p["penalty"]),
        w_gen: number(&p["w_gen"]),
        w_prune: number(&p["w_prune"]),
        init_lambda: number(&p["init_lambda"]),
        final_lambda: number(&p["final_lambda"]),
        tau_lambda: number(&p["tau_lambda"]),
        add_threshold: number(&p["add_threshold"]),
        norm_in: Some(vector(&p["norm_in"])),
        norm_out: Some(vector(&p["norm_out"])),
        ..LwprParams::default()
    }
}

/// Largest observed difference, and largest observed reference value.
#[derive(Default)]
struct Difference {
    difference: f64,
    reference: f64,
}

impl Difference {
    fn see(&mut self, ours: f64, theirs: f64) {
        assert!(ours.is_finite(), "{ours} instead of {theirs}");
        self.difference = self.difference.max((ours - theirs).abs());
        self.reference = self.reference.max(theirs.abs());
    }

    fn relative(&self) -> f64 {
        self.difference / self.reference
    }
}

fn check(path: &Path) {
    let name = path.file_stem().unwrap().to_str().unwrap();
    let file: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let (n_in, n_out) = (file["n_in"].as_u64().unwrap() as usize, file["n_out"].as_u64().unwrap() as usize);
    let mut model = params(&file).build(n_in, n_out).unwrap();
    let passes = file["passes"].as_u64().unwrap() as usize;
    let (xs, ys) = (samples(&file["x_train"]), samples(&file["y_train"]));
    model.fit_in_order(xs.as_view(), ys.as_view(), passes).unwrap();
    for output in 0..n_out {
        assert_eq!(model.n_receptive_fields(output) as u64, file["n_receptive_fields"][output], "{name}: fields");
        assert_eq!(model.n_pruned(output) as u64, file["n_pruned"][output], "{name}: pruned");
    }

    let predictor = model.predictor(number(&file["cutoff"]));
    let x_test = samples(&file["x_test"]);
    let [mut value, mut gradient, mut confidence, mut activation] = [(); 4].map(|()| Difference::default());
    let mut unsupported = 0;
    for (i, x) in x_test.column_iter().enumerate() {
        for output in 0..n_out {
            activation.see(predictor.max_activation(x.as_view(), output), number(&file["max_activation"][i][output]));
        }
        let Some(prediction) = predictor.predict(x.as_view()) else {
            // The library returns 0 ± 1e20.
            assert!((0..n_out).any(|output| number(&file["confidence"][i][output]) > 1e18), "{name}: point {i}");
            unsupported += 1;
            continue;
        };
        for output in 0..n_out {
            value.see(prediction.value[output], number(&file["value"][i][output]));
            for k in 0..n_in {
                gradient.see(prediction.gradient[(output, k)], number(&file["gradient"][i][output][k]));
            }
            // The library returns rounding noise for young fields.
            if name == "d2_young" {
                assert_eq!(prediction.confidence[output], f64::INFINITY);
            } else {
                confidence.see(prediction.confidence[output], number(&file["confidence"][i][output]));
            }
        }
    }
    assert!(unsupported > 0 && unsupported < x_test.ncols() / 2, "{name}: {unsupported} points without support");
    let worst = [value.relative(), gradient.relative(), activation.relative()];
    assert!(worst.into_iter().all(|difference| difference <= TOLERANCE), "{name}: {worst:?}");
    assert!(name == "d2_young" || confidence.relative() <= TOLERANCE, "{name}: {}", confidence.relative());
}

#[test]
fn every_trace_is_reproduced() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden");
    let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "json"));
    paths.sort();
    assert_eq!(paths.len(), 17);
    for path in paths {
        check(&path);
    }
}
