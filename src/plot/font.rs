//! Widths of letters: enough to know where a text ends without asking a font.
//!
//! Advance widths of Helvetica's metric-compatible twins (Arial, Liberation Sans 2.1) in thousandths of the font size; the
//! italic face has the same widths to 0.05 em except where the larger one is used. What is missing counts as 0.6 em.

/// Height of a capital letter, in fractions of the font size.
pub const CAP_HEIGHT: f64 = 0.72;
/// Depth of a descender, in fractions of the font size.
pub const DESCENT: f64 = 0.21;
/// Size of a sub- or superscript, in fractions of the font size.
pub const SCRIPT_SIZE: f64 = 0.72;
/// How far a superscript is raised, in fractions of the base font size.
pub const SUPER_SHIFT: f64 = 0.36;
/// How far a subscript is lowered, in fractions of the base font size.
pub const SUB_SHIFT: f64 = 0.18;

/// Widths of the characters from U+0020 to U+007E, upright.
const ASCII: [u16; 95] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556, 556, 556, 556, 556,
    556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833,
    722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556,
    556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334,
    260, 334, 584,
];

/// Widths of the same characters, bold.
const ASCII_BOLD: [u16; 95] = [
    278, 333, 474, 556, 556, 889, 722, 238, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556, 556, 556, 556, 556,
    556, 556, 556, 333, 333, 584, 584, 584, 611, 975, 722, 722, 722, 722, 667, 611, 778, 722, 278, 556, 722, 611, 833,
    722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 333, 278, 333, 584, 556, 333, 556, 611, 556, 611,
    556, 333, 611, 611, 278, 278, 556, 278, 889, 611, 611, 611, 611, 389, 556, 333, 611, 556, 778, 556, 556, 500, 389,
    280, 389, 584,
];

/// Advance width of a character in thousandths of the font size.
pub fn advance(letter: char, bold: bool) -> u16 {
    let code = u32::from(letter);
    if (0x20..0x7f).contains(&code) {
        let table = if bold { &ASCII_BOLD } else { &ASCII };
        return table[(code - 0x20) as usize];
    }
    let (plain, heavy) = match letter {
        'Γ' => (570, 601),
        'Δ' => (671, 719),
        'Θ' => (778, 778),
        'Λ' => (668, 667),
        'Ξ' => (650, 648),
        'Π' => (725, 725),
        'Σ' => (618, 600),
        'Φ' => (837, 837),
        'Ψ' => (835, 831),
        'Ω' => (761, 802),
        'α' => (578, 615),
        'β' => (575, 610),
        'γ' | 'κ' | 'λ' | 'ν' => (500, 558),
        'δ' => (557, 606),
        'ε' | 'ξ' => (448, 475),
        'ζ' => (463, 463),
        'η' | 'θ' | 'ο' => (556, 611),
        'ι' => (222, 278),
        'μ' => (576, 612),
        'π' => (690, 766),
        'ρ' => (573, 619),
        'σ' => (617, 684),
        'τ' => (395, 446),
        'υ' => (550, 582),
        'φ' => (652, 715),
        'χ' => (546, 576),
        'ψ' => (728, 753),
        'ω' => (781, 845),
        '−' | '×' => (584, 584),
        '–' => (556, 556),
        '—' | '…' | '→' | '←' => (1000, 1000),
        '±' | '≤' | '≥' | '≈' | '≠' | '√' => (549, 549),
        '·' | '\u{a0}' => (278, 278),
        '∞' => (713, 713),
        '∂' => (494, 494),
        '°' => (400, 400),
        '′' => (188, 240),
        '″' => (354, 479),
        '‘' | '’' => (222, 278),
        '“' | '”' => (333, 500),
        '\u{2009}' => (200, 200),
        'é' | 'è' | 'à' | 'ä' | 'ö' | 'ü' => (556, 611),
        _ => (600, 650),
    };
    if bold { heavy } else { plain }
}
