/// An error as the programs print it: what is wrong, where, and what helps, a line each, however many lines these texts have.
pub fn three_lines(what: &str, place: &str, remedy: &str) -> String {
    let line = |text: &str| text.lines().map(str::trim).collect::<Vec<_>>().join(" ");
    format!("error: {}\n  in:  {}\n  try: {}", line(what), line(place), line(remedy))
}
