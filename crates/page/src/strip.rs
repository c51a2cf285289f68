//! A strip: every data set of a cell as a dot, over the reference, so that outliers are visible.

use maud::{Markup, html};

use crate::{Reference, Scale};

/// Dimensions of the drawing, pixels.
const WIDTH: f64 = 190.0;
const HEIGHT: f64 = 24.0;
const AXIS_HEIGHT: f64 = 16.0;

/// Margin at either end, pixels, so that whole dots and labels are visible.
const INSET: f64 = 8.0;

/// Distance between dots and the upper and lower edge, pixels.
const EDGE: f64 = 4.0;

/// Vertical step between successive dots, as a share of the height: the golden ratio keeps neighbours apart.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// The values of a cell.
pub struct Strip<'a> {
    /// One value per data set; `None` if it has none.
    pub values: &'a [Option<f64>],
    /// Mean of the values.
    pub mean: f64,
    /// Median of the values.
    pub median: f64,
    /// The result for comparison.
    pub reference: Option<Reference>,
    /// Formats a value.
    pub show: &'a dyn Fn(f64) -> String,
}

impl Strip<'_> {
    /// Draws the dots over the band of the reference.
    pub fn drawn(&self, scale: Scale) -> Markup {
        let x = |value: f64| INSET + scale.place(value) * (WIDTH - 2.0 * INSET);
        let values = self.values.iter().enumerate().filter_map(|(i, value)| Some((i, (*value)?)));
        // All dots are one path, in which each is a line of length 0 with round ends, because a page has thousands of
        // dots.
        let dots: Vec<String> = values.map(|(i, value)| format!("M{} {}h0", pixels(x(value)), pixels(y(i)))).collect();
        html! {
            svg .strip viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } width=(WIDTH) height=(HEIGHT) role="img" aria-label=(self.summary()) {
                @if let Some(Reference { mean, sd }) = self.reference {
                    @let (from, to) = (x(mean - sd), x(mean + sd));
                    rect .band x=(pixels(from)) width=(pixels(to - from)) height=(HEIGHT) {}
                    (tick("printed", x(mean), 0.0))
                }
                path .dots d=(dots.concat()) {}
                (tick("median", x(self.median), HEIGHT * 0.6))
                (tick("mean", x(self.mean), 0.0))
            }
        }
    }

    /// A description of the strip, for readers who cannot see it.
    fn summary(&self) -> String {
        let values = self.values.iter().flatten();
        let (least, most) =
            values.clone().fold((f64::INFINITY, 0.0_f64), |(least, most), &v| (least.min(v), most.max(v)));
        let [least, most, median] = [least, most, self.median].map(self.show);
        format!("{} data sets between {least} and {most}, median {median}", values.count())
    }
}

/// The scale of the strips above or below.
pub fn axis(scale: Scale) -> Markup {
    let at = |value: f64| pixels(INSET + scale.place(value) * (WIDTH - 2.0 * INSET));
    html! {
        svg .axis viewBox={ "0 0 " (WIDTH) " " (AXIS_HEIGHT) } width=(WIDTH) height=(AXIS_HEIGHT) aria-hidden="true" {
            path d={ "M" (INSET) " .5H" (WIDTH - INSET) } {}
            @for (value, label) in scale.ticks() {
                path d={ "M" (at(value)) " 0v4" } {}
                text x=(at(value)) y="14" { (label) }
            }
        }
    }
}

/// The legend of dots and lines; `reference` names the band.
pub fn key(reference: &str) -> Markup {
    let sample = |drawing: Markup| html! { svg width="22" height="16" aria-hidden="true" { (drawing) } };
    html! {
        p .key {
            span { (sample(html! { circle cx="11" cy="8" r="2.5" {} })) "one data set" }
            span { (sample(html! { rect .band width="22" height="16" {} path .printed d="M11 0V16" {} })) (reference) }
            span { (sample(html! { path .mean d="M11 0V16" {} })) "our mean" }
            span { (sample(html! { path .median d="M11 8V16" {} })) "our median" }
        }
    }
}

fn tick(class: &str, x: f64, from: f64) -> Markup {
    html! { path class=(class) d={ "M" (pixels(x)) " " (pixels(from)) "V" (HEIGHT) } {} }
}

/// Vertical position of a data set's dot.
fn y(data_set: usize) -> f64 {
    EDGE + (GOLDEN * (data_set + 1) as f64).fract() * (HEIGHT - 2.0 * EDGE)
}

/// Rounds to a tenth of a pixel, which suffices.
fn pixels(value: f64) -> String {
    let text = format!("{value:.1}");
    text.strip_suffix(".0").unwrap_or(&text).to_owned()
}
