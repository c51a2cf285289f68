/// An error as the programs print it: fault, place and remedy, one line each, even if these texts have several lines.
pub fn three_lines(what: &str, place: &str, remedy: &str) -> String {
    let line = |text: &str| text.lines().map(str::trim).collect::<Vec<_>>().join(" ");
    format!("error: {}\n  in:  {}\n  try: {}", line(what), line(place), line(remedy))
}
