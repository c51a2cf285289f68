use kuva::plot::{BandPlot, ContourPlot, Heatmap, LegendPosition, LinePlot, MarkerShape, QuiverPlot, ScatterPlot};
use kuva::render::annotations::TextAnnotation;
use kuva::render::plots::Plot;
use kuva::render::render::render_multiple;

use crate::drawing::samples::{self, Sample};
use crate::drawing::sheet::{Edge, titled, uncrowd, with_axes};
use crate::drawing::smooth;
use crate::drawing::style::heights;
use crate::levels::Written;
use crate::{Field, Mark, Panel, Sketch, Stroke, colour_scale, levels};

/// A layer of the plane; later layers are drawn on top.
#[derive(Debug, Clone)]
pub enum Layer {
    /// Contours.
    Contours(Field),
    /// Contours at round values, with labels.
    Levels {
        /// Values on a grid.
        field: Field,
        /// Which values are known; those without an entry are not. The contours are at round values between the smallest and the largest
        /// known value, and their labels are among the known values.
        known: Vec<Vec<bool>>,
        /// Name of the contours in the legend.
        label: String,
    },
    /// A field in smooth colours, lighter with height, with a colour scale of this name.
    Colors {
        /// Values on a uniform grid.
        field: Field,
        /// Description of the values.
        name: String,
        /// Values of the darkest and the lightest colour, equal in panels for comparison; by default the range of the field.
        range: Option<[f64; 2]>,
    },
    /// A filled polygon whose intersection with every vertical line is connected.
    Region {
        /// In order.
        corners: Vec<(f64, f64)>,
        /// In HTML notation.
        color: &'static str,
        /// From 0 to 1.
        opacity: f64,
    },
    /// A line through points. A label adds it to the legend.
    Path {
        /// From start to end.
        points: Vec<(f64, f64)>,
        /// Its style.
        stroke: Stroke,
        /// Name in the legend.
        label: Option<String>,
    },
    /// Crosses.
    Crosses {
        /// Their centres.
        points: Vec<(f64, f64)>,
        /// In HTML notation.
        color: &'static str,
    },
    /// Dots.
    Dots {
        /// Their centres.
        points: Vec<(f64, f64)>,
        /// In HTML notation.
        color: &'static str,
        /// Radius in pixels.
        radius: f64,
    },
    /// Marks. A label adds them to the legend.
    Marks {
        /// Their centres.
        points: Vec<(f64, f64)>,
        /// Their shape.
        mark: Mark,
        /// In HTML notation.
        color: &'static str,
        /// Half their width, pixels.
        size: f64,
        /// Name in the legend.
        label: Option<String>,
    },
    /// Text centred just above a point, on top of all layers.
    Words {
        /// The point.
        at: (f64, f64),
        /// The text.
        text: String,
    },
    /// Arrows (x, y, u, v), in data units, with a scaled length. A label adds them to the legend.
    Arrows {
        /// Start and components.
        arrows: Vec<(f64, f64, f64, f64)>,
        /// In HTML notation.
        color: &'static str,
        /// Ratio of the drawn length to the length of the components.
        scale: f64,
        /// Width of the shaft, pixels.
        width: f64,
        /// Name in the legend.
        label: Option<String>,
    },
}

/// Layers in the plane, with the same scale on both axes.
#[derive(Debug, Clone)]
pub struct Plane {
    /// Title above the panel.
    pub title: String,
    /// Label of x, with its unit.
    pub x_label: String,
    /// Label of y, with its unit.
    pub y_label: String,
    /// Range of x.
    pub x: [f64; 2],
    /// Range of y.
    pub y: [f64; 2],
    /// The layers; later ones are drawn on top.
    pub layers: Vec<Layer>,
    /// Size in pixels.
    pub size: (f64, f64),
}

impl Plane {
    /// Width and height in pixels that suit a square region.
    pub const SQUARE: (f64, f64) = (400.0, 420.0);

    /// The names of lines and arrows in the legend.
    fn names(&self) -> Vec<(&str, Sample)> {
        fn name(layer: &Layer) -> Option<(&str, Sample)> {
            match layer {
                Layer::Path { label, .. } => Some((label.as_deref()?, Sample::Line)),
                Layer::Arrows { label, .. } => Some((label.as_deref()?, Sample::Arrow)),
                Layer::Levels { label, .. } => Some((label, Sample::Line)),
                _ => None,
            }
        }
        self.layers.iter().filter_map(name).collect()
    }

    /// The labels on contours of all layers.
    fn values(&self) -> Vec<Written> {
        let values_of = |layer: &Layer| match layer {
            Layer::Levels { field, known, .. } => levels::written(field, known),
            _ => vec![],
        };
        self.layers.iter().flat_map(values_of).collect()
    }
}

impl Panel for Plane {
    fn sketch(&self) -> Sketch {
        let plots: Vec<Plot> = self.layers.iter().filter_map(plot).collect();
        let (x, y) = (Edge { label: &self.x_label, range: self.x }, Edge { label: &self.y_label, range: self.y });
        let mut layout = with_axes(titled(&plots, &self.title, self.size), &x, &y)
            .with_show_grid(false)
            .with_legend_position(LegendPosition::OutsideBottomColumns)
            .with_legend_box(false)
            .with_equal_aspect();
        let values = self.values();
        let words = self.layers.iter().filter_map(words);
        layout.annotations = words.chain(values.iter().map(Written::annotation)).collect();
        let mut scene = render_multiple(plots, layout);
        uncrowd(&mut scene);
        let mut rasters = vec![];
        levels::put_on_lines(&values, &mut scene);
        for layer in &self.layers {
            if let Layer::Colors { name, field, range } = layer {
                colour_scale::complete(name, &mut scene);
                let range = range.unwrap_or_else(|| smooth::range(field.values().iter().flatten()));
                rasters.extend(smooth::instead_of_squares(field, range, rasters.len(), &mut scene));
            }
        }
        samples::draw(&self.names(), &mut scene);
        Sketch { scene, rasters }
    }
}

fn plot(layer: &Layer) -> Option<Plot> {
    Some(match layer.clone() {
        Layer::Words { .. } => return None,
        Layer::Levels { field, known, label } => return levels::lines(&field, &known, label),
        Layer::Contours(field) => {
            let (x, y, values) = (field.x().to_vec(), field.y().to_vec(), field.values().to_vec());
            let contours = ContourPlot::new().with_grid(values, x, y).with_n_levels(12);
            Plot::Contour(contours.with_line_color("#b8b8b8").with_line_width(0.8))
        }
        Layer::Colors { field, range, .. } => Plot::Heatmap(colors(&field, range)),
        Layer::Region { corners, color, opacity } => Plot::Band(band(&corners).with_color(color).with_opacity(opacity)),
        Layer::Path { points, stroke, label } => {
            let line = LinePlot::new().with_data(points).with_color(stroke.color).with_stroke_width(stroke.width);
            let line = line.with_line_style(stroke.dash.into());
            Plot::Line(if let Some(label) = label { line.with_legend(label) } else { line })
        }
        Layer::Crosses { points, color } => Plot::Scatter(
            ScatterPlot::new().with_data(points).with_color(color).with_size(2.5).with_marker(MarkerShape::Cross),
        ),
        Layer::Dots { points, color, radius } => {
            Plot::Scatter(ScatterPlot::new().with_data(points).with_color(color).with_size(radius))
        }
        Layer::Marks { points, mark, color, size, label } => {
            let marks = ScatterPlot::new().with_data(points).with_color(color).with_size(size).with_marker(mark.into());
            Plot::Scatter(if let Some(label) = label { marks.with_legend(label) } else { marks })
        }
        Layer::Arrows { arrows, color, scale, width, label } => {
            let quiver = QuiverPlot::new().with_arrows(arrows).with_color(color).with_scale(scale);
            let quiver = quiver.with_shaft_width(width).with_clip_to_plot_area();
            Plot::Quiver(if let Some(label) = label { quiver.with_legend(label) } else { quiver })
        }
    })
}

/// A stand-in for a field, with the same extent and range of colours. Its colour scale is drawn; its four squares are replaced by
/// [`smooth::instead_of_squares`].
fn colors(field: &Field, range: Option<[f64; 2]>) -> Heatmap {
    let (x, y) = (field.x(), field.y());
    let [low, high] = range.unwrap_or_else(|| smooth::range(field.values().iter().flatten()));
    Heatmap::new()
        .with_data(vec![vec![low, high]; 2])
        .with_x_range(x[0], x[x.len() - 1])
        .with_y_range(y[0], y[y.len() - 1])
        .with_cell_size(1.0)
        .with_color_map(heights())
}

fn words(layer: &Layer) -> Option<TextAnnotation> {
    let Layer::Words { at, text } = layer else { return None };
    Some(TextAnnotation::new(text, at.0, at.1).with_font_size(13))
}

/// The area between the lower and the upper edges of a polygon.
fn band(corners: &[(f64, f64)]) -> BandPlot {
    let mut x: Vec<f64> = corners.iter().map(|corner| corner.0).collect();
    x.sort_by(f64::total_cmp);
    x.dedup();
    let edges = || corners.iter().zip(corners.iter().cycle().skip(1));
    // Heights at which edges cross the vertical line at x; a vertical edge contributes both ends.
    let heights = |at: f64| {
        edges().filter(move |(a, b)| (a.0.min(b.0)..=a.0.max(b.0)).contains(&at)).flat_map(move |(a, b)| {
            let share = (at - a.0) / (b.0 - a.0);
            if a.0 == b.0 { [a.1, b.1] } else { [a.1 + share * (b.1 - a.1); 2] }
        })
    };
    let lower: Vec<f64> = x.iter().map(|&at| heights(at).fold(f64::INFINITY, f64::min)).collect();
    let upper: Vec<f64> = x.iter().map(|&at| heights(at).fold(f64::NEG_INFINITY, f64::max)).collect();
    BandPlot::new(x, lower, upper)
}

#[cfg(test)]
mod tests {
    use kuva::render::render::Primitive;

    use super::*;
    use crate::Dash;

    #[test]
    fn a_polygon_is_filled_between_its_lower_and_upper_edges() {
        let kite = band(&[(0.0, 0.0), (1.0, -1.0), (4.0, 0.0), (1.0, 1.0)]);
        assert_eq!(kite.x, [0.0, 1.0, 4.0]);
        assert_eq!((kite.y_lower, kite.y_upper), (vec![0.0, -1.0, 0.0], vec![0.0, 1.0, 0.0]));
        let slanted = band(&[(0.0, 0.0), (0.0, 2.0), (2.0, 4.0), (4.0, 2.0)]);
        assert_eq!((slanted.x, slanted.y_lower), (vec![0.0, 2.0, 4.0], vec![0.0, 1.0, 2.0]));
        assert_eq!(slanted.y_upper, [2.0, 4.0, 2.0]);
    }

    fn plane(layers: Vec<Layer>) -> Plane {
        let (x_label, y_label) = ("x".to_owned(), "y".to_owned());
        Plane { title: String::new(), x_label, y_label, x: [0.0, 1.0], y: [0.0, 1.0], layers, size: Plane::SQUARE }
    }

    #[test]
    fn equal_levels_of_two_layers_are_labelled_once() {
        let field = Field::new(vec![0.0, 1.0], vec![0.0, 1.0], vec![vec![0.0, 1.0], vec![1.0, 2.0]]).unwrap();
        let layer = Layer::Levels { field, known: vec![vec![true; 2]; 2], label: "equal".to_owned() };
        let heights = |layers: Vec<Layer>| {
            let scene = plane(layers).sketch().scene;
            let height = |element: &Primitive| match element {
                Primitive::Text { y, content, .. } if content == "1.0" => Some(*y),
                _ => None,
            };
            scene.elements.iter().filter_map(height).collect::<Vec<_>>()
        };
        let [once, twice] = [vec![layer.clone()], vec![layer.clone(), layer]].map(heights);
        assert!(!once.is_empty());
        assert!(twice.iter().all(|y| once.contains(y)), "{twice:?} {once:?}");
    }

    #[test]
    fn arrows_and_colours_are_named_as_they_are_drawn() {
        let field = Field::new(vec![0.0, 1.0], vec![0.0, 1.0], vec![vec![0.0, 1.0], vec![1.0, 2.0]]).unwrap();
        let (color, width, scale) = ("#d55e00", 1.0, 1.0);
        let arrows =
            Layer::Arrows { arrows: vec![(0.2, 0.2, 0.5, 0.5)], color, scale, width, label: Some("flow".to_owned()) };
        let stroke = Stroke { color: "#000000", width, dash: Dash::Solid };
        let path = Layer::Path { points: vec![(0.0, 0.0), (1.0, 1.0)], stroke, label: Some("way".to_owned()) };
        let layers = vec![Layer::Colors { field, name: "φ".to_owned(), range: None }, path, arrows];
        let scene = plane(layers).sketch().scene;
        let after = |name: &str| {
            let named = |element: &Primitive| matches!(element, Primitive::Text { content, .. } if content == name);
            let at = scene.elements.iter().position(named).unwrap();
            [1, 2].map(|step| scene.elements.get(at + step))
        };
        assert!(matches!(after("flow"), [Some(Primitive::Line { .. }), Some(Primitive::Path(head))]
            if head.fill == Some(color.into())));
        assert!(!matches!(after("way"), [Some(Primitive::Line { .. }), Some(Primitive::Path(_))]));
        after("φ");
    }
}
