//! Colours: the eight of Okabe and Ito, tints of them, and the batlow map for ordered quantities.
//!
//! Okabe and Ito, *Color Universal Design* (2008): told apart with every common form of colour blindness. batlow: Crameri,
//! Shephard and Heron, *The misuse of colour in science communication* (Nature Communications 11, 2020): perceptually uniform
//! and ordered in lightness; 17 of its 256 stops are kept here and joined linearly (within 2/255 of the original).

/// An opaque colour: red, green, blue.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Colour(pub u8, pub u8, pub u8);

impl Colour {
    /// Black.
    pub const BLACK: Colour = Colour(0, 0, 0);
    /// White.
    pub const WHITE: Colour = Colour(255, 255, 255);
    /// Middle grey for what only helps the eye.
    pub const GREY: Colour = Colour(128, 128, 128);
    /// Okabe-Ito orange.
    pub const ORANGE: Colour = Colour(230, 159, 0);
    /// Okabe-Ito sky blue.
    pub const SKY: Colour = Colour(86, 180, 233);
    /// Okabe-Ito bluish green.
    pub const GREEN: Colour = Colour(0, 158, 115);
    /// Okabe-Ito yellow.
    pub const YELLOW: Colour = Colour(240, 228, 66);
    /// Okabe-Ito blue.
    pub const BLUE: Colour = Colour(0, 114, 178);
    /// Okabe-Ito vermillion.
    pub const VERMILLION: Colour = Colour(213, 94, 0);
    /// Okabe-Ito reddish purple.
    pub const PURPLE: Colour = Colour(204, 121, 167);

    /// The colour mixed with white: `strength` percent of itself.
    pub const fn tint(self, strength: u8) -> Colour {
        const fn mix(value: u8, strength: u8) -> u8 {
            let strength = if strength > 100 { 100 } else { strength as u32 };
            ((value as u32 * strength + 255 * (100 - strength) + 50) / 100) as u8
        }
        Colour(mix(self.0, strength), mix(self.1, strength), mix(self.2, strength))
    }

    /// `#rrggbb`.
    pub fn hex(self) -> String {
        format!("#{:02x}{:02x}{:02x}", self.0, self.1, self.2)
    }
}

/// Stops of batlow at i/255 for i = 0, 16, …, 240, 255 (cmcrameri 1.10, rounded to bytes).
const BATLOW: [(u8, u8, u8); 17] = [
    (1, 25, 89),
    (13, 49, 93),
    (17, 67, 96),
    (23, 82, 98),
    (34, 96, 97),
    (53, 106, 89),
    (77, 115, 77),
    (103, 123, 62),
    (130, 130, 49),
    (161, 138, 43),
    (192, 144, 54),
    (221, 149, 77),
    (242, 157, 109),
    (252, 169, 147),
    (253, 180, 182),
    (252, 192, 216),
    (250, 204, 250),
];

/// The part of batlow that is dark enough for a thin line on white paper.
const BATLOW_TOP: f64 = 0.78;

/// batlow at `tone` in [0, 1] (clamped), restricted to its part that reads as a thin line on white.
pub fn batlow(tone: f64) -> Colour {
    let index = tone.clamp(0.0, 1.0) * BATLOW_TOP * 255.0;
    let stop = ((index / 16.0) as usize).min(BATLOW.len() - 2);
    let (from, to) = (BATLOW[stop], BATLOW[stop + 1]);
    let step = if stop == BATLOW.len() - 2 { 15.0 } else { 16.0 };
    let part = ((index - 16.0 * stop as f64) / step).clamp(0.0, 1.0);
    let mix = |a: u8, b: u8| (f64::from(a) + part * (f64::from(b) - f64::from(a)) + 0.5) as u8;
    Colour(mix(from.0, to.0), mix(from.1, to.1), mix(from.2, to.2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tints_run_from_white_to_the_colour() {
        assert_eq!(Colour::BLUE.tint(0), Colour::WHITE);
        assert_eq!(Colour::BLUE.tint(100), Colour::BLUE);
        assert_eq!(Colour(0, 100, 255).tint(50), Colour(128, 178, 255));
    }

    #[test]
    fn batlow_grows_lighter_all_the_way() {
        // Relative luminance after ITU-R BT.709 (without gamma: the order is what counts).
        let light = |c: Colour| 0.2126 * f64::from(c.0) + 0.7152 * f64::from(c.1) + 0.0722 * f64::from(c.2);
        let tones: Vec<f64> = (0..=40).map(|i| light(batlow(f64::from(i) / 40.0))).collect();
        assert!(tones.windows(2).all(|pair| pair[1] >= pair[0]), "{tones:?}");
        assert_eq!(batlow(0.0), Colour(1, 25, 89));
        assert_eq!(batlow(-3.0), batlow(0.0));
        assert!(light(batlow(1.0)) < 190.0, "the lightest line must still be seen on white");
    }
}
