use std::borrow::Cow;

/// Text in which every character is visible. Characters that move the cursor of a terminal or change its state, change
/// the writing direction, have no width or are not allowed in XML are escaped, as `\u{1b}`. Line ends and tabs are kept,
/// and so are joiners and selectors of emoji and of writing systems that need them, if they change the appearance.
pub fn plain(text: &str) -> Cow<'_, str> {
    let is_lost = |(at, c): (usize, char)| is_hidden(c) || is_joiner(c) && joins_nothing(text, at, c);
    if !text.char_indices().any(is_lost) {
        return Cow::Borrowed(text);
    }
    let mut spelt = String::with_capacity(text.len() + 8);
    for place in text.char_indices() {
        if is_lost(place) {
            spelt.extend(place.1.escape_unicode());
        } else {
            spelt.push(place.1);
        }
    }
    Cow::Owned(spelt)
}

/// Whether [`plain`] escapes a character regardless of its place.
pub fn is_hidden(c: char) -> bool {
    (c.is_control() && !matches!(c, '\n' | '\t')) || is_ignorable(c) && !is_joiner(c) || is_no_character(c)
}

/// Invisible characters: Unicode's default ignorable code points, assigned or not; and line separators and other format
/// characters (Cf, Zl, Zp) without a visible form.
fn is_ignorable(c: char) -> bool {
    matches!(c,
        '\u{ad}' | '\u{34f}' | '\u{61c}' | '\u{115f}' | '\u{1160}' | '\u{17b4}' | '\u{17b5}' | '\u{180b}'..='\u{180f}'
        | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{3164}'
        | '\u{fe00}'..='\u{fe0f}' | '\u{feff}' | '\u{ffa0}' | '\u{fff0}'..='\u{fffb}' | '\u{13430}'..='\u{1343f}'
        | '\u{1bca0}'..='\u{1bca3}' | '\u{1d173}'..='\u{1d17a}' | '\u{e0000}'..='\u{e0fff}')
}

/// Code points that will never be characters, including the last two of every plane.
fn is_no_character(c: char) -> bool {
    matches!(c, '\u{fdd0}'..='\u{fdef}') || u32::from(c) & 0xfffe == 0xfffe
}

/// Joiners and selectors have no width either, but can change the appearance of adjacent characters.
fn is_joiner(c: char) -> bool {
    matches!(c, '\u{200c}' | '\u{200d}' | '\u{fe0e}' | '\u{fe0f}')
}

/// Whether a joiner, at this byte of a text, has no visible effect at its place.
fn joins_nothing(text: &str, at: usize, c: char) -> bool {
    let (before, after) = (&text[..at], text[at + c.len_utf8()..].chars().next());
    // An emoji may be followed by a selector before it is joined to the next.
    let joins = |is: fn(char) -> bool, before: &str| before.ends_with(is) && after.is_some_and(is);
    match c {
        '\u{200c}' => !joins(is_cursive, before),
        '\u{200d}' => !joins(is_cursive, before) && !joins(is_emoji, before.strip_suffix('\u{fe0f}').unwrap_or(before)),
        _ => !before.ends_with(is_emoji),
    }
}

/// Letters and marks of blocks whose shapes depend on their neighbours: Arabic to Sinhala, and Mongolian.
fn is_cursive(c: char) -> bool {
    matches!(c, '\u{600}'..='\u{dff}' | '\u{1800}'..='\u{18af}') && !is_ignorable(c)
}

/// Symbols of blocks with emoji, and the skin tones that follow them.
fn is_emoji(c: char) -> bool {
    matches!(c, '\u{2190}'..='\u{2bff}' | '\u{1f000}'..='\u{1faff}')
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn only_invisible_characters_are_escaped() {
        for text in ["x", "q̇ (rad/s)", "ω₁ → 左\t\n", "👩‍🚀", "❤️", "👩🏽‍❤️‍👩🏽", "می‌خواهم", "र्‍य", "a\u{a0}b\u{3000}c"]
        {
            assert!(matches!(plain(text), Cow::Borrowed(same) if same == text), "{text:?}");
        }
        assert_eq!(plain("a\u{1b}]0;b\u{7}c\r"), r"a\u{1b}]0;b\u{7}c\u{d}");
        assert_eq!(
            plain("\0\u{b}\u{7f}\u{9b}\u{202e}\u{2069}\u{ffff}"),
            r"\u{0}\u{b}\u{7f}\u{9b}\u{202e}\u{2069}\u{ffff}"
        );
        assert!(!plain(&('\0'..=char::MAX).collect::<String>()).contains(is_hidden));
    }

    #[test]
    fn a_joiner_between_letters_that_do_not_join_is_spelt_out() {
        for c in ['\u{200c}', '\u{200d}', '\u{fe0e}', '\u{fe0f}'] {
            for (before, after) in [("", ""), ("x", "y"), ("é", "é"), ("左", "左"), ("", "👩"), ("\u{fe0f}", "👩")]
            {
                let spelt = plain(&format!("{before}{c}{after}")).into_owned();
                assert!(spelt.contains(&c.escape_unicode().to_string()), "{spelt:?}");
            }
        }
        assert_eq!(plain("👩\u{fe0f}\u{fe0f}"), "👩\u{fe0f}\\u{fe0f}");
    }

    /// Some characters of these categories have a visible form: signs before numbers.
    const HIDDEN: &str = r"[\p{Cc}\p{Cf}\p{Zl}\p{Zp}\p{Default_Ignorable_Code_Point}\p{Noncharacter_Code_Point}--\p{Prepended_Concatenation_Mark}\n\t]{100}";
    const VISIBLE: &str = r"[\p{L}\p{M}\p{N}\p{P}\p{S}\p{Zs}\p{Co}--\p{Default_Ignorable_Code_Point}]{100}";

    proptest! {
        /// The strings of all cases together contain nearly every character of the categories.
        #[test]
        fn every_hidden_character_is_spelt_out(hidden in HIDDEN) {
            for c in hidden.chars() {
                let text = format!("x{c}y");
                prop_assert_eq!(plain(&text), format!("x{}y", c.escape_unicode()));
            }
            prop_assert!(plain(&hidden).is_ascii());
        }

        #[test]
        fn every_visible_character_stays(visible in VISIBLE) {
            prop_assert_eq!(plain(&visible), &*visible);
        }
    }
}
