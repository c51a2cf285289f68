use std::sync::Arc;

use kuva::plot::{BandPlot, LinePlot};
use kuva::render::annotations::TextAnnotation;
use kuva::render::color::Color;
use kuva::render::layout::{ComputedLayout, TickFormat};
use kuva::render::plots::Plot;
use kuva::render::render::{Scene, render_multiple};

use crate::axis::tick;
use crate::drawing::elements::line;
use crate::drawing::sheet::{Edge, titled, with_axes};
use crate::names::{self, Name};
use crate::{Axis, Panel, Sign, Sketch, Stroke};

/// Means and standard deviations of a quantity.
#[derive(Debug, Clone)]
pub struct Curve {
    /// (x, mean, standard deviation).
    pub points: Vec<(f64, f64, f64)>,
    /// Style of the line through the means; the band has the same colour.
    pub stroke: Stroke,
    /// Marks at the points, if any.
    pub sign: Option<Sign>,
    /// Label next to its last point, if that is on the axis.
    pub name: String,
}

/// Curves of quantities: lines through the means, with bands. On a linear axis a band extends one standard deviation up
/// and down. On a logarithmic one it extends that far up and visually as far down, and therefore never reaches 0.
/// Curves that leave the range end at its edge.
#[derive(Debug, Clone)]
pub struct Curves {
    /// Title above the panel.
    pub title: String,
    /// Label of the varied quantity, with its unit.
    pub x_label: String,
    /// Label of the measured quantity, with its unit.
    pub y_label: String,
    /// Spacing of x; a logarithmic axis is not broken, whatever its `lowest`.
    pub x_axis: Axis,
    /// Spacing of y.
    pub y_axis: Axis,
    /// Range.
    pub x: [f64; 2],
    /// Range.
    pub y: [f64; 2],
    /// Distance between ticks: in units of x, or in decades of a logarithmic axis.
    pub x_step: f64,
    /// The curves; later ones are drawn on top.
    pub lines: Vec<Curve>,
    /// Notes among the curves.
    pub notes: Vec<Note>,
    /// Width to the right of the axes for the names of curves, pixels.
    pub room: f64,
    /// Size in pixels, including that width.
    pub size: (f64, f64),
}

/// A text centred above a point.
#[derive(Debug, Clone)]
pub struct Note {
    /// The point.
    pub at: (f64, f64),
    /// The text.
    pub text: String,
}

/// Opacity of a band.
const BAND: f64 = 0.13;

/// Number of steps of a band between two points, so that the edge of the range cuts it correctly.
const STEPS: usize = 24;

impl Panel for Curves {
    fn sketch(&self) -> Sketch {
        let bands = self.lines.iter().map(|curve| self.band(curve));
        let lines = self.lines.iter().flat_map(|curve| self.line(curve).into_iter().chain(self.marks(curve)));
        let plots: Vec<Plot> = bands.chain(lines).collect();
        let range = self.y_axis.places(self.y);
        let across = [0, 1].map(|end| self.x_axis.place(self.x[end], self.x[0]));
        let (x, y) = (Edge { label: &self.x_label, range: across }, Edge { label: &self.y_label, range });
        let layout = with_axes(titled(&plots, &self.title, (self.size.0 - self.room, self.size.1)), &x, &y);
        let mut layout = layout.with_x_tick_step(self.x_step).with_grid_line_width(0.6);
        if let Axis::Logarithmic { .. } = self.x_axis {
            layout = layout.with_x_tick_format(plainly(self.x[0]));
        }
        if let Axis::Logarithmic { .. } = self.y_axis {
            layout = layout.with_y_tick_step(1.0).with_y_tick_format(plainly(self.y[0]));
        }
        layout.annotations = self.notes.iter().map(|note| self.words(note)).collect();
        let drawn = ComputedLayout::from_layout(&layout);
        let mut scene = render_multiple(plots, layout);
        if self.y_axis != Axis::Linear && range[0] < 0.0 {
            broken((drawn.margin_left, drawn.map_y(0.0)), &mut scene);
        }
        let end = |curve: &Curve| {
            let &(x, mean, _) = curve.points.last()?;
            let place = self.place(mean);
            self.is_on_axis(place).then(|| (drawn.map_x(self.across(x)), drawn.map_y(place)))
        };
        let named = self.lines.iter().filter(|curve| !curve.name.is_empty());
        let named =
            named.filter_map(|curve| Some(Name { text: &curve.name, color: curve.stroke.color, end: end(curve)? }));
        names::draw(named.collect(), self.size.0 - self.room + NAME_GAP, &mut scene);
        scene.width = self.size.0;
        Sketch::new(scene)
    }
}

/// Distance between axes and names, pixels.
const NAME_GAP: f64 = 14.0;

impl Curves {
    /// Position of a value of y.
    fn place(&self, value: f64) -> f64 {
        self.y_axis.place(value, self.y[0])
    }

    /// Position of a value of x.
    fn across(&self, value: f64) -> f64 {
        self.x_axis.place(value, self.x[0])
    }

    fn is_on_axis(&self, place: f64) -> bool {
        let [low, high] = self.y_axis.places(self.y);
        (low..=high).contains(&place)
    }

    /// The band around a curve, within the axis.
    fn band(&self, curve: &Curve) -> Plot {
        let [low, high] = self.y_axis.places(self.y);
        let edge = |end: usize| {
            let at = |&(x, mean, sd): &(f64, f64, f64)| (self.across(x), self.place(self.y_axis.band(mean, sd)[end]));
            fine(&curve.points.iter().map(at).collect::<Vec<_>>())
        };
        let (lower, upper) = (edge(0), edge(1));
        let within = |edge: &[(f64, f64)]| edge.iter().map(|point| point.1.clamp(low, high)).collect::<Vec<_>>();
        let band = BandPlot::new(lower.iter().map(|point| point.0), within(&lower), within(&upper));
        Plot::Band(band.with_color(curve.stroke.color).with_opacity(BAND))
    }

    /// The line through the means, in pieces if it leaves the axis and returns.
    fn line(&self, curve: &Curve) -> Vec<Plot> {
        let points: Vec<_> = curve.points.iter().map(|&(x, mean, _)| (self.across(x), self.place(mean))).collect();
        let line = |piece: Vec<(f64, f64)>| {
            let line = LinePlot::new().with_data(piece).with_color(curve.stroke.color);
            Plot::Line(line.with_stroke_width(curve.stroke.width).with_line_style(curve.stroke.dash.into()))
        };
        inside(&points, self.y_axis.places(self.y)).into_iter().map(line).collect()
    }

    fn marks(&self, curve: &Curve) -> Vec<Plot> {
        let places = curve.points.iter().map(|&(x, mean, _)| (self.across(x), self.place(mean)));
        let points: Vec<_> = places.filter(|point| self.is_on_axis(point.1)).collect();
        curve.sign.map_or(vec![], |sign| sign.plots(&points, curve.stroke.color))
    }

    fn words(&self, Note { at, text }: &Note) -> TextAnnotation {
        TextAnnotation::new(text, self.across(at.0), self.place(at.1)).with_font_size(13)
    }
}

/// Labels at integer positions of a logarithmic axis, written by [`tick`].
fn plainly(from: f64) -> TickFormat {
    TickFormat::Custom(Arc::new(move |place| tick(place, from)))
}

/// The points, with additional ones evenly between them.
fn fine(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let between = |pair: &[(f64, f64)]| {
        let [a, b] = [pair[0], pair[1]];
        (0..STEPS).map(move |step| along(a, b, step as f64 / STEPS as f64))
    };
    points.windows(2).flat_map(between).chain(points.last().copied()).collect()
}

fn along(a: (f64, f64), b: (f64, f64), share: f64) -> (f64, f64) {
    (a.0 + share * (b.0 - a.0), a.1 + share * (b.1 - a.1))
}

/// The pieces of a line between two heights.
fn inside(points: &[(f64, f64)], [low, high]: [f64; 2]) -> Vec<Vec<(f64, f64)>> {
    let is_inside = |point: &(f64, f64)| (low..=high).contains(&point.1);
    let mut pieces: Vec<Vec<(f64, f64)>> = vec![];
    for pair in points.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let (start, end) = if is_inside(&a) && is_inside(&b) {
            (a, b)
        } else {
            let mut crossings = [low, high].map(|height| (height - a.1) / (b.1 - a.1));
            crossings.sort_by(f64::total_cmp);
            let [enters, leaves] = [crossings[0].max(0.0), crossings[1].min(1.0)];
            if enters >= leaves {
                continue;
            }
            (along(a, b, enters), along(a, b, leaves))
        };
        match pieces.last_mut() {
            Some(piece) if piece.last() == Some(&start) => piece.push(end),
            _ => pieces.push(vec![start, end]),
        }
    }
    pieces
}

/// Two strokes across an axis, because its scale changes below.
fn broken((x, y): (f64, f64), scene: &mut Scene) {
    const HALF: (f64, f64) = (7.0, 3.0);
    for below in [6.0, 11.0] {
        let (from, to) = ((x - HALF.0, y + below + HALF.1), (x + HALF.0, y + below - HALF.1));
        scene.add(line(from, to, Color::from("black"), 1.2));
    }
}

#[cfg(test)]
mod tests {
    use kuva::render::render::Primitive;

    use super::*;
    use crate::{Dash, Filling, Mark};

    fn panel(points: Vec<(f64, f64, f64)>, y_axis: Axis, y: [f64; 2]) -> Curves {
        let stroke = Stroke { color: "#d55e00", width: 1.8, dash: Dash::Solid };
        let sign = Some(Sign { mark: Mark::Circle, filling: Filling::Hollow });
        let lines = vec![Curve { points, stroke, sign, name: "here".to_owned() }];
        let (title, x_label, y_label) = (String::new(), "x".to_owned(), "y".to_owned());
        let (x_axis, x, x_step, room, size) = (Axis::Linear, [0.0, 100.0], 20.0, 80.0, (580.0, 400.0));
        Curves { title, x_label, y_label, x_axis, y_axis, x, y, x_step, lines, notes: vec![], room, size }
    }

    /// Centres of all round marks.
    fn circles(scene: &Scene) -> Vec<(f64, f64)> {
        let circles = |element: &Primitive| match element {
            Primitive::CircleBatch { cx, cy, .. } => cx.iter().copied().zip(cy.iter().copied()).collect(),
            _ => vec![],
        };
        scene.elements.iter().flat_map(circles).collect()
    }

    /// Left end and baseline of the curve's name.
    fn name(scene: &Scene) -> Option<(f64, f64)> {
        scene.elements.iter().find_map(|element| match element {
            Primitive::Text { x, y, content, .. } if content == "here" => Some((*x, *y)),
            _ => None,
        })
    }

    #[test]
    fn marks_follow_the_axis_and_the_last_is_labelled() {
        let points = vec![(0.0, 0.01, 0.05), (50.0, 0.1, 0.0), (100.0, 1.0, 20.0)];
        let scene = panel(points, Axis::Logarithmic { lowest: 1e-3 }, [1e-3, 10.0]).sketch().scene;
        let circles = circles(&scene);
        assert_eq!(circles.len(), 6);
        assert_eq!(circles[..3], circles[3..]);
        // One decade each: equal steps to the right and up.
        let [a, b, c] = circles[..3] else { unreachable!() };
        assert!((b.0 - a.0 - (c.0 - b.0)).abs() < 0.05 && b.0 > a.0 + 100.0, "{circles:?}");
        assert!((b.1 - a.1 - (c.1 - b.1)).abs() < 0.05 && b.1 < a.1 - 50.0, "{circles:?}");
        let (x, y) = name(&scene).unwrap();
        assert!(x > c.0 && x < 580.0 && (y - c.1).abs() < 6.0, "{x} {y} beside {c:?}");
    }

    #[test]
    fn a_power_of_x_is_straight_where_both_axes_are_logarithmic() {
        let points: Vec<_> = [10.0_f64, 1e3, 1e4].iter().map(|x| (*x, 1e-3 * x * x.sqrt(), 0.0)).collect();
        let logarithmic = Axis::Logarithmic { lowest: 1e-3 };
        let across =
            Curves { x_axis: logarithmic, x: [10.0, 1e5], x_step: 1.0, ..panel(points, logarithmic, [1e-3, 1e5]) };
        let scene = across.sketch().scene;
        let [a, b, c] = circles(&scene)[..3] else { panic!("three points") };
        assert!(
            (b.0 - a.0 - 2.0 * (c.0 - b.0)).abs() < 0.1 && c.0 > b.0 + 40.0,
            "two decades, then one: {a:?} {b:?} {c:?}"
        );
        assert!(((a.1 - b.1) / (b.0 - a.0) - (b.1 - c.1) / (c.0 - b.0)).abs() < 1e-3, "{a:?} {b:?} {c:?}");
        assert!(name(&scene).unwrap().0 > c.0);
        for tick in ["100", "1000", "10⁴", "10⁵"] {
            let is = |element: &&Primitive| matches!(element, Primitive::Text { content, .. } if content == tick);
            assert!(scene.elements.iter().any(|element| is(&element)), "{tick}");
        }
    }

    #[test]
    fn a_curve_without_a_sign_has_its_line_alone() {
        let mut bare = panel(vec![(0.0, 0.1, 0.0), (100.0, 1.0, 0.0)], Axis::Linear, [0.0, 2.0]);
        let lines =
            |scene: &Scene| scene.elements.iter().filter(|element| matches!(element, Primitive::Path(_))).count();
        let with = bare.sketch().scene;
        bare.lines[0].sign = None;
        let without = bare.sketch().scene;
        assert_eq!((circles(&with).len(), circles(&without).len()), (4, 0));
        assert_eq!(lines(&with), lines(&without));
        assert!(lines(&without) > 0 && name(&without).is_some());
    }

    #[test]
    fn points_beyond_the_axis_have_no_mark_or_name() {
        let points = vec![(0.0, 0.01, 0.0), (50.0, 0.1, 0.0), (100.0, 1000.0, 0.0)];
        let scene = panel(points, Axis::Logarithmic { lowest: 1e-3 }, [1e-3, 10.0]).sketch().scene;
        assert_eq!(circles(&scene).len(), 4);
        assert_eq!(name(&scene), None);
    }

    #[test]
    fn far_below_a_broken_axis_points_are_still_apart() {
        let points = vec![(0.0, 1e-22, 0.0), (50.0, 1e-20, 0.0), (100.0, 1e-2, 0.0)];
        let scene = panel(points, Axis::Logarithmic { lowest: 1e-23 }, [1e-3, 10.0]).sketch().scene;
        let [a, b, c] = circles(&scene)[..3] else { panic!("three points") };
        assert!(a.1 - b.1 > 8.0 && b.1 - c.1 > 100.0, "{a:?} {b:?} {c:?}");
        let ticks = ["10⁻²³", "10⁻¹³", "0.001", "10"];
        for tick in ticks {
            let is = |element: &&Primitive| matches!(element, Primitive::Text { content, .. } if content == tick);
            assert_eq!(scene.elements.iter().filter(is).count(), 1, "{tick}");
        }
    }

    #[test]
    fn lines_are_cut_at_the_edges_of_the_range() {
        let cut = |points: &[(f64, f64)]| inside(points, [0.0, 1.0]);
        assert_eq!(
            cut(&[(0.0, 0.5), (1.0, 1.5), (2.0, 1.5), (3.0, 0.5)]),
            [vec![(0.0, 0.5), (0.5, 1.0)], vec![(2.5, 1.0), (3.0, 0.5)]]
        );
        assert_eq!(cut(&[(0.0, -1.0), (4.0, 3.0)]), [vec![(1.0, 0.0), (2.0, 1.0)]]);
        assert_eq!(cut(&[(0.0, 0.0), (1.0, 1.0), (2.0, 1.0)]), [vec![(0.0, 0.0), (1.0, 1.0), (2.0, 1.0)]]);
        assert_eq!(cut(&[(0.0, 2.0), (1.0, 1.0), (2.0, 0.5), (3.0, 0.5)]), [vec![(1.0, 1.0), (2.0, 0.5), (3.0, 0.5)]]);
        assert!(cut(&[(0.0, 2.0), (1.0, 3.0), (2.0, 3.0)]).is_empty() && cut(&[]).is_empty());
    }
}
