//! The plain shapes of a domain.

use crate::frame::Vector;

/// A bevelled box about a ship, in her lengths: how far it reaches, and the fraction of the side reach
/// to which it is bevelled at the bow and at the stern.
pub(super) struct BevelledBox {
    fore: f64,
    aft: f64,
    port: f64,
    starboard: f64,
    bow: f64,
    stern: f64,
}

impl BevelledBox {
    /// The symmetric base of the "colregs" domain: two lengths ahead and astern, one and a half
    /// abeam. The bevel leans by a multiple of 22.5°, like the sides of the disc that is added: the
    /// sum has 16 edges instead of 20. The safety margin is not in here, it is in that disc.
    pub fn symmetric() -> Self {
        let (along, abeam) = (2.0, 1.5);
        let bevel = 1.0 - (std::f64::consts::PI / 8.0).tan() * (along / 2.0) / abeam;
        Self {
            fore: along,
            aft: along,
            port: abeam,
            starboard: abeam,
            bow: bevel,
            stern: bevel,
        }
    }

    /// The "paper" domain: a large forbidden region in front and to starboard.
    pub fn one_size() -> Self {
        Self {
            fore: 6.0,
            aft: 2.0,
            port: 1.5,
            starboard: 4.0,
            bow: 0.5,
            stern: 0.5,
        }
    }

    /// `P(f, a, p, s, kf, ka)` of docs/colregs.md 3.3, `(ahead, to port)` in units of `length`.
    pub fn corners(&self, length: f64) -> [Vector; 8] {
        [
            (self.fore, -self.bow * self.starboard),
            (self.fore, self.bow * self.port),
            (self.fore / 2.0, self.port),
            (-self.aft / 2.0, self.port),
            (-self.aft, self.stern * self.port),
            (-self.aft, -self.stern * self.starboard),
            (-self.aft / 2.0, -self.starboard),
            (self.fore / 2.0, -self.starboard),
        ]
        .map(|(ahead, port)| Vector::new(ahead, port) * length)
    }
}
