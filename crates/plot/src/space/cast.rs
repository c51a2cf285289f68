//! Renders bodies as pixels: each sample of the panel shows the first body on its line of sight, and the transparent
//! bodies before it.

use nalgebra::{Point2, Vector3};

use super::item::Item;
use super::shade::{self, Rgb, Tint};
use super::solid::{Hit, Solid};
use super::view::View;
use crate::drawing::raster::{DOTS, Raster};

/// A body and its paint.
#[derive(Debug, Clone)]
pub(super) struct Body {
    pub(super) solid: Solid,
    pub(super) tint: Tint,
}

/// Samples along a side of a dot, and of a pixel.
const FINE: usize = 2;
const SAMPLES: usize = FINE * DOTS;
/// Width of outlines, pixels.
const INK: f64 = 0.9;
/// Neighbours are on different faces if the dot product of their normals is smaller.
const SAME_FACE: f64 = 0.7;

/// The bodies among the items.
pub(super) fn bodies(items: &[Item], view: &View) -> Vec<Body> {
    let body = |item: &Item| Some(Body { tint: item.paint()?.into(), solid: Solid::of(item, view)? });
    items.iter().filter_map(body).collect()
}

/// An image of the bodies on a panel of this size, pixels; `None` without bodies.
pub(super) fn raster(bodies: &[Body], size: (f64, f64)) -> Option<Raster> {
    let mut film = Film::over(Window::around(bodies, size)?);
    let (opaque, veils): (Vec<&Body>, Vec<&Body>) = bodies.iter().partition(|body| body.tint.opacity >= 1.0);
    for body in opaque {
        for (at, depth, color) in film.window.samples_of(body) {
            if depth > film.depths[at] {
                film.depths[at] = depth;
                film.colors[at] = color;
            }
        }
    }
    film.veil(&veils);
    Some(film.raster())
}

/// A part of the panel: its corner in pixels, its sides in samples.
#[derive(Debug, Clone, Copy)]
struct Window {
    corner: Point2<f64>,
    width: usize,
    height: usize,
}

impl Window {
    /// The part that contains all bodies with a margin of one pixel, in whole pixels.
    fn around(bodies: &[Body], size: (f64, f64)) -> Option<Window> {
        let bounds = bodies.iter().map(|body| body.solid.bounds());
        let [low, high] = bounds.reduce(|[low, high], [a, b]| [low.inf(&a), high.sup(&b)])?;
        let low = low.map(|side| (side.floor() - 1.0).max(0.0));
        let (right, below) = ((high.x.ceil() + 1.0).min(size.0), (high.y.ceil() + 1.0).min(size.1));
        let samples = |from: f64, to: f64| (to - from).max(0.0) as usize * SAMPLES;
        let (width, height) = (samples(low.x, right), samples(low.y, below));
        (width > 0 && height > 0).then_some(Window { corner: low, width, height })
    }

    /// The centre of a sample on the panel.
    fn place(&self, column: usize, row: usize) -> Point2<f64> {
        let pixels = |sample: usize| (sample as f64 + 0.5) / SAMPLES as f64;
        self.corner + nalgebra::Vector2::new(pixels(column), pixels(row))
    }

    /// The samples that a body covers: index, depth and colour. Its outline is always opaque.
    fn samples_of(&self, body: &Body) -> Vec<(usize, f32, [f32; 4])> {
        let part = self.part(body);
        let place = |at: usize| self.place(part.columns.start + at % part.width(), part.rows.start + at / part.width());
        let hits: Vec<Option<Hit>> = (0..part.width() * part.rows.len()).map(|at| body.solid.hit(&place(at))).collect();
        let inked = inked(&hits, part.width());
        let sample = |(at, hit): (usize, &Option<Hit>)| {
            let Hit { depth, normal } = (*hit)?;
            let (color, share) = if inked[at] {
                (shade::ink(&body.tint), 1.0)
            } else {
                (shade::seen(&body.tint, &normal), body.tint.opacity)
            };
            let [red, green, blue] = color;
            let (column, row) = (part.columns.start + at % part.width(), part.rows.start + at / part.width());
            Some((row * self.width + column, depth as f32, [red, green, blue, share].map(|part| part as f32)))
        };
        hits.iter().enumerate().filter_map(sample).collect()
    }

    /// The columns and rows that a body may cover, with a margin of one sample for its outline.
    fn part(&self, body: &Body) -> Part {
        let [low, high] = body.solid.bounds().map(|end| (end - self.corner) * SAMPLES as f64);
        let range = |from: f64, to: f64, most: usize| {
            let from = ((from.floor() - 1.0).max(0.0) as usize).min(most);
            from..((to.ceil() + 1.0).max(0.0) as usize).clamp(from, most)
        };
        Part { columns: range(low.x, high.x, self.width), rows: range(low.y, high.y, self.height) }
    }
}

/// Columns and rows of samples.
struct Part {
    columns: std::ops::Range<usize>,
    rows: std::ops::Range<usize>,
}

impl Part {
    fn width(&self) -> usize {
        self.columns.len()
    }
}

/// Which samples of a body are on its outline or on an edge between two faces.
fn inked(hits: &[Option<Hit>], width: usize) -> Vec<bool> {
    let mut inked = vec![false; hits.len()];
    let outline = INK * SAMPLES as f64;
    let mut stamp = |at: usize, radius: f64| {
        let (column, row, pixels) = (at % width, at / width, radius.floor() as usize);
        for y in row.saturating_sub(pixels)..(row + pixels + 1).min(hits.len() / width) {
            for x in column.saturating_sub(pixels)..(column + pixels + 1).min(width) {
                let aside = x.abs_diff(column).pow(2) + y.abs_diff(row).pow(2);
                if (aside as f64) < radius * radius {
                    inked[x + y * width] = true;
                }
            }
        }
    };
    for (at, hit) in hits.iter().enumerate() {
        let Some(hit) = hit else { continue };
        for beside in neighbours(at, width, hits.len()) {
            match &hits[beside] {
                None => stamp(at, outline),
                Some(other) if other.normal.dot(&hit.normal) < SAME_FACE => stamp(at, outline / 2.0),
                Some(_) => {}
            }
        }
    }
    inked
}

/// Left, right, upper and lower neighbour, as far as they exist.
fn neighbours(at: usize, width: usize, len: usize) -> impl Iterator<Item = usize> {
    let (left, right) = ((!at.is_multiple_of(width)).then(|| at - 1), (at % width + 1 < width).then_some(at + 1));
    let (above, below) = (at.checked_sub(width), (at + width < len).then_some(at + width));
    [left, right, above, below].into_iter().flatten()
}

/// The samples of a window: colour (red, green, blue, opacity) and depth.
struct Film {
    window: Window,
    colors: Vec<[f32; 4]>,
    depths: Vec<f32>,
}

impl Film {
    fn over(window: Window) -> Film {
        let n = window.width * window.height;
        Film { window, colors: vec![[0.0; 4]; n], depths: vec![f32::NEG_INFINITY; n] }
    }

    /// Blends transparent samples over those behind them, the farthest first.
    fn veil(&mut self, bodies: &[&Body]) {
        let mut veils: Vec<(usize, f32, [f32; 4])> = vec![];
        for body in bodies {
            let samples = self.window.samples_of(body).into_iter();
            veils.extend(samples.filter(|(at, depth, _)| *depth > self.depths[*at]));
        }
        veils.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        for (at, _, [red, green, blue, share]) in veils {
            let veil = [red, green, blue, 1.0];
            let below = self.colors[at];
            self.colors[at] = std::array::from_fn(|i| share * veil[i] + (1.0 - share) * below[i]);
        }
    }

    /// The mean over the samples of each dot.
    fn raster(&self) -> Raster {
        let (width, height) = (self.window.width / FINE, self.window.height / FINE);
        let dot = |at: usize| {
            let (column, row) = (at % width * FINE, at / width * FINE);
            let samples = (0..FINE * FINE).map(|i| (row + i / FINE) * self.window.width + column + i % FINE);
            let sum = samples.fold([0.0; 4], |sum: [f32; 4], at| std::array::from_fn(|i| sum[i] + self.colors[at][i]));
            let part = |color: f32| if sum[3] > 0.0 { (color / sum[3]).round() as u8 } else { 0 };
            let share = (255.0 * sum[3] / (FINE * FINE) as f32).round() as u8;
            [part(sum[0]), part(sum[1]), part(sum[2]), share]
        };
        let Point2 { coords: corner } = self.window.corner;
        Raster {
            corner: (corner.x, corner.y),
            side: 1.0 / DOTS as f64,
            width,
            dots: (0..width * height).map(dot).collect(),
        }
    }
}

/// The colour of a small object at a position and depth of the panel: `None` if an opaque body hides it, otherwise
/// tinted by the transparent bodies before it.
pub(super) fn seen(color: Rgb, at: &Point2<f64>, depth: f64, bodies: &[Body]) -> Option<Rgb> {
    let mut veils: Vec<(f64, &Tint)> = vec![];
    for Body { solid, tint } in bodies {
        match solid.hit(at) {
            Some(hit) if hit.depth > depth && tint.opacity >= 1.0 => return None,
            Some(hit) if hit.depth > depth => veils.push((hit.depth, tint)),
            _ => {}
        }
    }
    veils.sort_by(|a, b| a.0.total_cmp(&b.0));
    let tinted = |below: Rgb, (_, tint): &(f64, &Tint)| {
        let veil = shade::seen(tint, &Vector3::z());
        std::array::from_fn(|i| tint.opacity * veil[i] + (1.0 - tint.opacity) * below[i])
    };
    Some(veils.iter().fold(color, tinted))
}
