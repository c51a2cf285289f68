use std::borrow::Cow;

/// Text in which every character is visible. What moves the cursor of a terminal or changes its state, what turns the
/// direction of writing, and what XML does not allow is spelt out, as `\u{1b}`; ends of lines and tabs stay.
pub fn plain(text: &str) -> Cow<'_, str> {
    if !text.contains(is_hidden) {
        return Cow::Borrowed(text);
    }
    let mut visible = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        if is_hidden(c) {
            visible.extend(c.escape_unicode());
        } else {
            visible.push(c);
        }
    }
    Cow::Owned(visible)
}

/// Whether [`plain`] spells a character out.
pub fn is_hidden(c: char) -> bool {
    // Marks, embeddings, overrides and isolates of direction; separators of lines; what is no character.
    let turns = matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{206f}');
    let breaks = matches!(c, '\u{2028}' | '\u{2029}' | '\u{feff}' | '\u{fffe}' | '\u{ffff}');
    turns || breaks || (c.is_control() && !matches!(c, '\n' | '\t'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_seen_is_spelt_out_and_nothing_else() {
        for text in ["x", "q̇ (rad/s)", "ω₁ → 左\t\n", "👩‍🚀"] {
            assert!(matches!(plain(text), Cow::Borrowed(same) if same == text));
        }
        assert_eq!(plain("a\u{1b}]0;b\u{7}c\r"), r"a\u{1b}]0;b\u{7}c\u{d}");
        assert_eq!(
            plain("\0\u{b}\u{7f}\u{9b}\u{202e}\u{2069}\u{ffff}"),
            r"\u{0}\u{b}\u{7f}\u{9b}\u{202e}\u{2069}\u{ffff}"
        );
        assert!(!plain(&('\0'..=char::MAX).collect::<String>()).contains(is_hidden));
    }
}
