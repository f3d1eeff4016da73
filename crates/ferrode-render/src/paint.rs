//! Colours and patterns.

/// A colour as screens and style sheets count it (sRGB), each part from 0 to 1, with opacity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Color {
    /// Red.
    pub r: f32,
    /// Green.
    pub g: f32,
    /// Blue.
    pub b: f32,
    /// Opacity: 1 hides what is behind.
    pub a: f32,
}

impl Color {
    /// White.
    pub const WHITE: Self = Self::rgb(255, 255, 255);
    /// Nearly black.
    pub const BLACK: Self = Self::rgb(24, 26, 30);
    /// A soft red.
    pub const RED: Self = Self::rgb(224, 88, 74);
    /// A soft green.
    pub const GREEN: Self = Self::rgb(92, 176, 104);
    /// A soft blue.
    pub const BLUE: Self = Self::rgb(70, 134, 208);
    /// A soft yellow.
    pub const YELLOW: Self = Self::rgb(242, 186, 73);
    /// Middle grey.
    pub const GREY: Self = Self::rgb(150, 154, 160);

    /// Colours that go well together and are told apart easily, for things without a colour of their own.
    pub const PALETTE: [Self; 8] = [
        Self::rgb(226, 92, 78),
        Self::rgb(72, 140, 212),
        Self::rgb(244, 190, 82),
        Self::rgb(88, 178, 122),
        Self::rgb(160, 116, 196),
        Self::rgb(240, 142, 82),
        Self::rgb(66, 176, 182),
        Self::rgb(226, 128, 164),
    ];

    /// An opaque colour from bytes.
    pub const fn rgb(r: u8, g: u8, b: u8) -> Self {
        Self { r: r as f32 / 255.0, g: g as f32 / 255.0, b: b as f32 / 255.0, a: 1.0 }
    }

    /// The n-th of [`Color::PALETTE`], over and over.
    pub const fn of(n: usize) -> Self {
        Self::PALETTE[n % Self::PALETTE.len()]
    }

    /// The same with another opacity.
    #[must_use]
    pub const fn with_alpha(self, a: f32) -> Self {
        Self { a, ..self }
    }

    /// Between this colour (0) and another (1).
    #[must_use]
    pub fn mixed(self, other: Self, t: f32) -> Self {
        let mix = |a: f32, b: f32| a + (b - a) * t;
        Self {
            r: mix(self.r, other.r),
            g: mix(self.g, other.g),
            b: mix(self.b, other.b),
            a: mix(self.a, other.a),
        }
    }

    /// In proportion to light, as shaders count it (IEC 61966-2-1).
    pub(crate) fn linear(self) -> [f32; 4] {
        let part = |c: f32| {
            let c = f64::from(c.clamp(0.0, 1.0));
            let l = if c <= 0.040_45 { c / 12.92 } else { ferrode_math::real::pow((c + 0.055) / 1.055, 2.4) };
            l as f32
        };
        [part(self.r), part(self.g), part(self.b), self.a.clamp(0.0, 1.0)]
    }
}

/// What a surface's colour is like across it. Patterns are in the shape's own coordinates, so that they turn with it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Pattern {
    /// One colour.
    #[default]
    Plain = 0,
    /// A board of two shades, each field a quarter of a metre.
    Checkered = 1,
    /// Grain along x.
    Wood = 2,
    /// Eight fields of two shades, that show how a ball turns.
    Octants = 3,
    /// Blotches as of earth and grass, from above.
    Earth = 4,
    /// Clouds: white shines through in soft spots.
    Clouds = 5,
}

/// How a surface looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paint {
    /// Its colour; with an opacity below 1 what is behind shines through.
    pub color: Color,
    /// How the colour varies.
    pub pattern: Pattern,
    /// It throws a shadow.
    pub shadow: bool,
    /// Light and shade play no part: the colour is shown as it is.
    pub glowing: bool,
}

impl From<Color> for Paint {
    fn from(color: Color) -> Self {
        Self { color, pattern: Pattern::Plain, shadow: true, glowing: false }
    }
}

impl Paint {
    /// The same with a pattern.
    #[must_use]
    pub fn with_pattern(self, pattern: Pattern) -> Self {
        Self { pattern, ..self }
    }

    /// The same without a shadow.
    #[must_use]
    pub fn shadowless(self) -> Self {
        Self { shadow: false, ..self }
    }

    /// The same, shown as it is, whatever the light.
    #[must_use]
    pub fn glowing(self) -> Self {
        Self { glowing: true, shadow: false, ..self }
    }
}
