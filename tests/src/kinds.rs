//! Curves of every kind that the solver goes a way of its own for: what is promised of all curves is tried on these.

use crate::curves::MARKER;
use minvar::curve::{
    Continuity, Curve, CurveError, Element, Functional, Joint, Obstacle, Options, Quantity, Reference,
    Report, Side, elements_len, solve, update, workspace_len,
};
use minvar::solve::{Observer, Record, Silent, Status};

/// Data and options of a curve.
#[derive(Clone, Debug)]
pub struct Kind {
    /// What it is, in words.
    pub name: &'static str,
    /// The joints.
    pub joints: Vec<Joint>,
    /// Whether it returns to its start.
    pub closed: bool,
    /// What it keeps clear of.
    pub obstacles: Vec<Obstacle>,
    /// A reference shape with its weight; without elements there is none.
    pub reference: (Vec<Element>, f64),
    /// The elements that the search starts from; without any it starts from the data.
    pub last: Vec<Element>,
    /// The options.
    pub options: Options,
    /// How the computation ends.
    pub status: Status,
}

impl Kind {
    fn new(name: &'static str, joints: Vec<Joint>, options: Options) -> Self {
        let reference = (Vec::new(), 0.0);
        Self {
            name,
            joints,
            closed: false,
            obstacles: Vec::new(),
            reference,
            last: Vec::new(),
            options,
            status: Status::Converged,
        }
    }

    /// The data as the kernel takes them.
    pub fn curve(&self) -> Curve<'_> {
        let curve = Curve::new(&self.joints, self.closed).with_obstacles(&self.obstacles);
        let (elements, weight) = &self.reference;
        if elements.is_empty() {
            curve
        } else {
            curve.with_reference(Reference { elements, weight: *weight })
        }
    }

    /// The workspace that it needs.
    ///
    /// # Panics
    ///
    /// Never: the data are good.
    pub fn workspace_len(&self) -> usize {
        workspace_len(&self.curve(), &self.options).expect("good data")
    }

    /// Room for its elements, and three more that nobody may touch, full of [`MARKER`]; the last solution where it
    /// starts from one.
    pub fn room(&self) -> Vec<Element> {
        let mut room = vec![MARKER; elements_len(&self.curve(), &self.options) + 3];
        room[..self.last.len()].copy_from_slice(&self.last);
        room
    }

    /// Computes it, from the data or from the last solution.
    ///
    /// # Errors
    ///
    /// Those of [`solve`].
    pub fn run(
        &self,
        workspace: &mut [f64],
        elements: &mut [Element],
        records: &mut [Record],
        observer: &mut dyn Observer,
    ) -> Result<Report, CurveError> {
        let compute = if self.last.is_empty() { solve } else { update };
        compute(&self.curve(), &self.options, workspace, elements, records, observer)
    }

    /// Its elements.
    fn solved(&self) -> Vec<Element> {
        let mut elements = self.room();
        let mut workspace = vec![0.0; self.workspace_len()];
        let report = self.run(&mut workspace, &mut elements, &mut [], &mut Silent).expect("good data");
        elements.truncate(report.elements);
        elements
    }
}

fn planar(points: &[[f64; 2]]) -> Vec<Joint> {
    points.iter().map(|&[x, y]| Joint::at([x, y, 0.0])).collect()
}

/// Woodford's points (thesis Fig. 4.11).
fn woodford() -> Vec<Joint> {
    planar(&[[0.0, 0.0], [1.0, 1.9], [2.0, 2.7], [3.0, 2.6], [4.0, 1.6], [5.0, 0.89], [6.0, 1.2]])
}

/// The coving of thesis 4.11.5.
fn coving() -> Vec<Joint> {
    vec![
        Joint::at([0.5, -12.0, 0.0])
            .with_tangent(Quantity::fixed([0.0, 1.0, 0.0]))
            .with_curvature(Quantity::fixed([0.27, 0.0, 0.0])),
        Joint::at([20.0, -0.5, 0.0]).with_tangent(Quantity::fixed([1.0, 0.0, 0.0])),
    ]
}

/// Opposite ends of a line, both looking the same way across it: without a bound on its length there is no minimum.
fn antipodal() -> Vec<Joint> {
    let end = |x| Joint::at([x, 0.0, 0.0]).with_tangent(Quantity::fixed([-0.5, 1.0, 0.0]));
    vec![end(-2.0), end(2.0)]
}

fn in_space() -> Vec<Joint> {
    [[0.0, 0.0, 0.0], [1.0, 1.0, 0.3], [2.0, 0.2, 1.0], [3.0, 1.0, 1.2], [3.5, 2.0, 2.0]]
        .map(Joint::at)
        .to_vec()
}

/// Around an oval, up and down by so much.
fn around(height: f64) -> Vec<Joint> {
    let radii = [1.0, 1.3, 0.9, 1.1, 1.4, 1.0];
    (0u8..)
        .zip(radii)
        .map(|(i, radius)| {
            let angle = std::f64::consts::TAU * f64::from(i) / 6.0;
            Joint::at([2.0 * radius * libm::cos(angle), radius * libm::sin(angle), height * f64::from(i % 2)])
        })
        .collect()
}

fn helical() -> Vec<Joint> {
    (0..6)
        .map(|i| {
            let angle = 0.7 * f64::from(i);
            Joint::at([libm::cos(angle), libm::sin(angle), 0.3 * angle])
        })
        .collect()
}

/// All kinds.
pub fn kinds() -> Vec<Kind> {
    let plain = Options::DEFAULT;
    let divided = |elements_per_span| Options { elements_per_span, ..plain };
    let of = |functional| Options { functional, ..plain };
    let mut all = vec![
        Kind::new("two joints", coving(), plain),
        Kind::new("two joints, eight elements", coving(), divided(8)),
        Kind::new("seven points", woodford(), plain),
        Kind::new("seven points, four elements a span", woodford(), divided(4)),
        Kind::new("loosely asked", woodford(), Options { relative_decrease: 1e-6, ..plain }),
        Kind::new(
            "loosely asked, four elements a span",
            woodford(),
            Options { relative_decrease: 1e-6, ..divided(4) },
        ),
        Kind::new("least bending", woodford(), of(Functional::MEC)),
        Kind::new("scale-invariant variation", woodford(), of(Functional::SI_MVC)),
        Kind::new("scale-invariant bending", woodford(), of(Functional::SI_MEC)),
        Kind::new("tension and bending", woodford(), Options { tension: 0.3, bending: 0.2, ..plain }),
        Kind::new("a given length", woodford(), Options { length: 9.0, ..plain }),
        Kind::new("a given length in parts", woodford(), Options { length: 9.0, ..divided(3) }),
        Kind::new("a given rule", woodford(), Options { quadrature_points: 20, ..plain }),
        Kind::new("a tolerance in a plane", woodford(), Options { tolerance: 1e-5, ..divided(64) }),
        Kind::new("a tolerance in space", in_space(), Options { tolerance: 1e-3, ..divided(64) }),
        Kind::new("a continuation", woodford(), Options { continuation: 3, ..plain }),
        Kind::new("a continuation in parts", woodford(), Options { continuation: 2, ..divided(2) }),
        Kind::new("planar data in space", woodford(), Options { dimension: 3, ..plain }),
        Kind::new("points in space", in_space(), plain),
        Kind::new("points in space, three elements a span", in_space(), divided(3)),
        Kind::new("variation with torsion", helical(), of(Functional::SPACE_MVC)),
        Kind::new("bending with torsion", helical(), of(Functional::SPACE_MEC)),
        Kind::new(
            "variation with torsion in parts",
            helical(),
            Options { functional: Functional::SPACE_MVC, ..divided(2) },
        ),
        Kind { status: Status::Unbounded, ..Kind::new("no minimum", antipodal(), plain) },
        Kind {
            status: Status::IterationLimit,
            ..Kind::new("few iterations", woodford(), Options { max_iterations: 3, dimension: 3, ..plain })
        },
        Kind { closed: true, ..Kind::new("a ring", around(0.0), plain) },
        Kind { closed: true, ..Kind::new("a ring in parts", around(0.0), divided(3)) },
        Kind { closed: true, ..Kind::new("a ring in space", around(0.4), plain) },
    ];

    // Thesis Fig. 4.9: one specification, several minima.
    let mut looped = planar(&[[-1.5, 0.0], [-0.5, 0.5], [0.0, 1.0], [0.5, 0.5], [1.5, 0.0]]);
    looped[0] = looped[0].with_tangent(Quantity::initial([1.0, 0.1, 0.0]));
    looped[2] = looped[2]
        .with_tangent(Quantity::initial([-1.0, 0.0, 0.0]))
        .with_curvature(Quantity::fixed([0.0, -10.0, 0.0]));
    looped[4] = looped[4].with_tangent(Quantity::initial([1.0, -0.1, 0.0]));
    all.push(Kind::new("a loop", looped, divided(2)));

    let mut corners = woodford();
    corners[2].continuity = Continuity::G1;
    corners[4].continuity = Continuity::G0;
    all.push(Kind::new("a corner and a jump of curvature", corners, plain));

    let mut slides = woodford();
    slides[3] = slides[3].on_line([3.0, 2.6, 0.0], [0.0, 1.0, 0.0]);
    slides[5].position = Quantity::initial([5.0, 0.89, 0.0]);
    all.push(Kind::new("joints that slide", slides.clone(), plain));
    all.push(Kind::new("joints that slide, in parts", slides, divided(3)));

    let mut slides = in_space();
    slides[2] = slides[2].on_plane([2.0, 0.2, 1.0], [1.0, 0.0, 0.2]);
    slides[3] = slides[3].with_curvature(Quantity::of_size([0.0, -0.4, 0.1]));
    all.push(Kind::new("joints that slide in space, a curvature's size", slides, plain));

    // Thesis Fig. 4.15.
    let loose = |[x, y]: [f64; 2], [dx, dy]: [f64; 2]| {
        Joint::at([x, y, 0.0])
            .with_position(Quantity::initial([x, y, 0.0]))
            .with_tangent(Quantity::initial([dx, dy, 0.0]))
    };
    let eight = vec![
        loose([-2.0, 0.0], [0.0, 1.0]),
        loose([0.0, 0.0], [1.0, -1.0]),
        loose([2.0, 0.0], [0.0, 1.0]),
        loose([0.0, 0.0], [-1.0, -1.0]),
    ];
    all.push(Kind {
        closed: true,
        ..Kind::new("a ring of which nothing is fixed", eight, of(Functional::SI_MVC))
    });

    let ends = || {
        let mut ends = coving();
        ends[0].curvature = [Quantity::FREE; 2];
        ends
    };
    let duct = [
        Obstacle::segment([0.0, -6.0, 0.0], [6.0, -6.0, 0.0], 0.25, Side::LEFT),
        Obstacle::segment([6.0, -6.0, 0.0], [6.0, 0.0, 0.0], 0.25, Side::LEFT),
    ];
    for (name, parts) in [("obstacles", 1), ("obstacles, in parts", 3)] {
        all.push(Kind { obstacles: duct.to_vec(), ..Kind::new(name, ends(), divided(parts)) });
    }

    let mut moved = woodford();
    moved[3].position.value[1] = 2.7;
    let shape = Kind::new("", woodford(), plain).solved();
    all.push(Kind { reference: (shape, 0.7), ..Kind::new("a reference shape", moved.clone(), plain) });
    let shape = Kind::new("", woodford(), divided(2)).solved();
    let few = Options { max_iterations: 40, ..divided(2) };
    all.push(Kind {
        reference: (shape, 0.7),
        status: Status::IterationLimit,
        ..Kind::new("a reference shape in parts, few iterations", moved.clone(), few)
    });
    let last = Kind::new("", woodford(), plain).solved();
    all.push(Kind { last: last.clone(), ..Kind::new("a last solution", moved.clone(), plain) });
    let loose = Options { relative_decrease: 1e-6, ..plain };
    all.push(Kind { last, ..Kind::new("a last solution, loosely", moved, loose) });
    let last = Kind::new("", in_space(), divided(2)).solved();
    let mut moved = in_space();
    moved[1].position.value[2] = 0.5;
    all.push(Kind { last, ..Kind::new("a last solution in space", moved, divided(2)) });
    all
}
