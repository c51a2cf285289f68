//! Writes a page that compares two learners by strips of dots, and the same comparison as a Markdown table: `results_page
//! [FILE]`.

#![allow(clippy::print_stdout, reason = "a program")]

use std::error::Error;
use std::path::PathBuf;

use maud::html;
use page::{Document, Part, Scale, Strip, axis, emphasised, markdown_table};

fn main() -> Result<(), Box<dyn Error>> {
    let default = || std::env::temp_dir().join("results.html");
    let path = std::env::args().nth(1).map_or_else(default, PathBuf::from);

    // Errors on five data sets; the second learner's third is missing.
    let learners = [
        ("slope GP", [0.02, 0.03, 0.07, 0.02, 0.04].map(Some)),
        ("naive", [Some(0.5), Some(0.61), None, Some(0.44), Some(0.52)]),
    ];
    let show = |value: f64| format!("{value:.2}");
    let scale = Scale::around(learners.iter().flat_map(|(_, values)| values.iter().copied().flatten()), []);
    let (mut strips, mut rows) = (Vec::new(), Vec::new());
    for (name, values) in &learners {
        let mut known: Vec<f64> = values.iter().copied().flatten().collect();
        known.sort_by(f64::total_cmp);
        let (mean, median) = (known.iter().sum::<f64>() / known.len() as f64, known[known.len() / 2]);
        let strip = Strip { values, mean, median, reference: None, show: &show };
        strips.push(html! { tr { th { (name) } td { (strip.drawn(scale)) } } });
        rows.push(vec![(*name).to_owned(), show(mean), show(median)]);
    }

    let body = html! {
        h1 #results { "Two learners" }
        p { (emphasised("Errors of the policy, **less is better**; dots are data sets.")) }
        table { @for strip in &strips { (strip) } tr { th {} td { (axis(scale)) } } }
    };
    let opening = Part { id: "results".to_owned(), title: "Results".to_owned(), body };
    let page = Document { title: "Two learners", name: "example", opening, parts: vec![], style: "" }.html();
    std::fs::write(&path, &page)?;
    println!("{} ({} bytes)\n", path.display(), page.len());
    print!("{}", markdown_table(&["learner", "mean", "median"], &rows));
    Ok(())
}
