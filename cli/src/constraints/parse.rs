//! From words to joints, obstacles and a curve as they are written.

use super::fault::{did_you_mean, quote};
use super::position::SLIDING;
use super::resolve::{Curve, Joint, Written};
use super::words::{Kind, Place, Word, Words};
use super::{Continuity, Fault, Given, NamedJoint};

pub(super) type Parsed<T> = Result<T, Box<Fault>>;

/// What a form begins with.
const HEADS: [&str; 5] = ["G2Joint", "G1Joint", "G0Joint", "G2Curve", "Obstacle"];

/// Reads the forms of a file, up to the first that is wrong.
pub(super) fn forms(text: &str) -> Parsed<Written<'_>> {
    let mut parser = Parser { text, words: Words::new(text) };
    let mut written = Written::default();
    loop {
        let open = parser.words.next();
        match open.kind {
            Kind::End => return Ok(written),
            Kind::Open => {}
            Kind::Close => return Err(parser.fault(open, "this `)` closes nothing")),
            Kind::Comma | Kind::Text => return Err(parser.stray(open)),
        }
        let head = parser.words.next();
        match head.text.to_ascii_lowercase().as_str() {
            "g0joint" => written.joints.push(parser.joint(open, Continuity::G0)?),
            "g1joint" => written.joints.push(parser.joint(open, Continuity::G1)?),
            "g2joint" => written.joints.push(parser.joint(open, Continuity::G2)?),
            "obstacle" => written.obstacles.push(parser.obstacle(open)?),
            "g2curve" => {
                let curve = parser.curve(open)?;
                if let Some(first) = &written.curve {
                    let message = format!("curve {} is a second curve: a file holds one", quote(curve.name));
                    let fault = Fault::error(text, curve.place, message);
                    return Err(fault.earlier(text, first.place, "the first curve"));
                }
                written.curve = Some(curve);
            }
            _ => return Err(parser.unknown_head(open, head)),
        }
    }
}

/// The words still to be read, and the text for messages about them.
pub(super) struct Parser<'a> {
    pub(super) text: &'a str,
    pub(super) words: Words<'a>,
}

/// What a form inside a joint says.
struct Condition {
    place: Place,
    is_tangent: bool,
    /// Arriving and leaving.
    sides: [bool; 2],
    sided: bool,
    value: Value,
}

/// The value of a condition.
enum Value {
    Given(Given),
    /// A curvature's size without a direction.
    Size(f64),
}

/// What has been read of a joint's conditions.
#[derive(Default)]
struct Seen {
    /// Where each was given: of the curvature and the tangent, arriving and leaving.
    places: [[Option<Place>; 2]; 2],
    /// Curvatures of which only the size was given, arriving and leaving.
    sizes: [Option<f64>; 2],
}

impl<'a> Parser<'a> {
    pub(super) fn fault(&self, at: Word<'_>, message: impl Into<String>) -> Box<Fault> {
        Fault::error(self.text, at.place, message)
    }

    /// `expected …, found …` at a word.
    pub(super) fn expected(&self, expected: &str, found: Word<'_>) -> Box<Fault> {
        self.fault(found, format!("expected {expected}, found {}", describe(found)))
    }

    /// The file ends within a form.
    pub(super) fn unclosed(&self, open: Word<'_>, what: &str) -> Box<Fault> {
        self.fault(open, format!("a `)` is missing: the file ends inside {what}"))
    }

    /// A form begins within another.
    pub(super) fn still_open(&self, open: Word<'_>, inner: Word<'_>, what: &str) -> Box<Fault> {
        let message = format!("a `)` is missing before this form: {what} is still open");
        self.fault(inner, message).earlier(self.text, open.place, "it begins here")
    }

    fn stray(&self, word: Word<'_>) -> Box<Fault> {
        let fault = self.expected("`(` to begin a joint, an obstacle or a curve", word);
        match word.text {
            "-" | "*" | "•" => fault.help("list markers are not part of the format: take it away"),
            _ => fault.help("a comment begins with `;` or `#`"),
        }
    }

    fn unknown_head(&self, open: Word<'_>, head: Word<'_>) -> Box<Fault> {
        match head.kind {
            Kind::End => self.unclosed(open, "this form"),
            Kind::Text => {
                let fault = self.fault(head, format!("unknown keyword {}", quote(head.text)));
                match head.text.to_ascii_lowercase().as_str() {
                    "g0curve" | "g1curve" => fault
                        .help("a curve is always `G2Curve`; its joints say what is continuous (`G1Joint`, `G0Joint`)"),
                    _ => fault.help(
                        did_you_mean(head.text, HEADS).unwrap_or_else(|| format!("a form begins with {}", heads())),
                    ),
                }
            }
            _ => self.expected(&heads(), head),
        }
    }

    /// A joint after its keyword: name, index, position and conditions.
    fn joint(&mut self, open: Word<'a>, continuity: Continuity) -> Parsed<Joint> {
        let name = self.name(open, "joint")?;
        let what = format!("joint {}", quote(name.text));
        let position = self.position(open, &what)?;
        let Place { line, column, .. } = open.place;
        let mut joint = NamedJoint {
            name: name.text.to_owned(),
            continuity,
            position,
            tangent: [Given::Free; 2],
            curvature: [Given::Free; 2],
            line,
            column,
        };
        let mut seen = Seen::default();
        loop {
            let word = self.words.next();
            match word.kind {
                Kind::Close => {
                    self.turn_sizes(&mut joint, &seen)?;
                    return Ok(Joint { place: open.place.to(name.place), value: joint });
                }
                Kind::End => return Err(self.unclosed(open, &what)),
                Kind::Open => {}
                Kind::Comma | Kind::Text => {
                    return Err(self.expected(
                        &format!("`(Fixed …`, `(Initial …`, `(Size …` or the `)` of {what}"),
                        word,
                    ));
                }
            }
            let condition = self.condition(open, word, &what)?;
            self.apply(condition, &mut joint, &mut seen)?;
        }
    }

    fn name(&mut self, open: Word<'a>, of: &str) -> Parsed<Word<'a>> {
        let name = self.words.next();
        match name.kind {
            Kind::End => Err(self.unclosed(open, &format!("a {of}"))),
            Kind::Text if !is_any(name.text, &["fixed", "initial", "open", "closed"]) => Ok(name),
            _ => {
                Err(self.fault(name, format!("this {of} has no name: found {} in its place", describe(name))))
            }
        }
    }

    /// `Fixed | Initial | Size  Tangent | Curvature  [Arriving | Leaving]  (x,y,z) )` after its parenthesis. A size may be a
    /// number.
    fn condition(&mut self, open: Word<'a>, inner: Word<'a>, what: &str) -> Parsed<Condition> {
        let status = self.words.next();
        let given: fn([f64; 3]) -> Given = match status.text.to_ascii_lowercase().as_str() {
            "fixed" => Given::Fixed,
            "initial" => Given::Initial,
            "size" => Given::Size,
            _ if is_head(status) => return Err(self.still_open(open, inner, what)),
            lower => {
                let fault = match status.kind {
                    Kind::End => return Err(self.unclosed(open, what)),
                    Kind::Text => {
                        self.fault(status, format!("unknown keyword {} in {what}", quote(status.text)))
                    }
                    _ => self.expected("`Fixed`, `Initial` or `Size`", status),
                };
                return Err(match did_you_mean(status.text, ["Fixed", "Initial", "Size"]) {
                    _ if looks_like_number(lower) || lower == "line" || lower == "plane" => {
                        fault.help(format!("a joint that slides is written `{SLIDING}`"))
                    }
                    _ if lower == "tangent" || lower == "curvature" => {
                        fault.help(format!("say which: `(Fixed {0} …` or `(Initial {0} …`", status.text))
                    }
                    Some(help) if status.kind == Kind::Text => fault.help(help),
                    _ => fault.help("a condition is `(Fixed Tangent (x,y,z))`, or Initial, or Curvature, or `(Size Curvature (x,y,z))`"),
                });
            }
        };

        let property = self.words.next();
        let is_tangent = match property.text.to_ascii_lowercase().as_str() {
            "tangent" => true,
            "curvature" => false,
            _ => {
                let fault = match property.kind {
                    Kind::End => return Err(self.unclosed(open, what)),
                    Kind::Text => {
                        self.fault(property, format!("unknown keyword {} in {what}", quote(property.text)))
                    }
                    _ => self.expected("`Tangent` or `Curvature`", property),
                };
                let near = did_you_mean(property.text, ["Tangent", "Curvature"]);
                return Err(fault.help(near.unwrap_or("a joint has a Tangent and a Curvature".to_owned())));
            }
        };
        let property_name = if is_tangent { "the tangent" } else { "the curvature" };
        let size = status.text.eq_ignore_ascii_case("size");
        if size && is_tangent {
            let fault = self.fault(status, format!("the tangent of {what} cannot be given by its size"));
            return Err(fault.help("a tangent is a direction: only a curvature has a size"));
        }

        let mut word = self.words.next();
        let mut sides = [true, true];
        let is_size = |word: Word<'_>| size && word.kind == Kind::Text && looks_like_number(word.text);
        let sided = word.kind == Kind::Text && !is_size(word);
        if sided {
            sides = match word.text.to_ascii_lowercase().as_str() {
                "arriving" => [true, false],
                "leaving" => [false, true],
                _ => {
                    let fault = self.expected(&format!("the value of {property_name} of {what}"), word);
                    return Err(match did_you_mean(word.text, ["Arriving", "Leaving"]) {
                        Some(help) => fault.help(help),
                        None if size => fault.help("a size is `(x,y,z)`, as long as the curvature, or a number"),
                        None if !is_tangent && looks_like_number(word.text) => fault.help(
                            "a value stands in parentheses: `(x,y,z)`; a size alone is `(Size Curvature 0.27)`",
                        ),
                        None => fault.help("a value stands in parentheses: `(x,y,z)`"),
                    });
                }
            };
            word = self.words.next();
        }
        if word.kind == Kind::Close {
            return Err(self.fault(word, format!("{property_name} of {what} has no value")));
        }
        let value = if is_size(word) {
            let size = self.number(word)?;
            if size < 0.0 {
                let fault = self.fault(word, format!("the size of the curvature of {what} is negative"));
                return Err(
                    fault.help("to say which side, give a vector to the centre: `(Size Curvature (x,y,z))`")
                );
            }
            Value::Size(size)
        } else {
            let (point, place) = self.point(open, word, what, property_name)?;
            if is_tangent && point == [0.0; 3] {
                let message = format!("the tangent of {what} has no direction: all coordinates are zero");
                return Err(Fault::error(self.text, place, message));
            }
            Value::Given(given(point))
        };
        self.close(open, what)?;
        Ok(Condition { place: inner.place.to(property.place), is_tangent, sides, sided, value })
    }

    /// Writes a condition into its joint, once a side.
    fn apply(&self, condition: Condition, joint: &mut NamedJoint, seen: &mut Seen) -> Parsed<()> {
        let Condition { place, is_tangent, sides, sided, value } = condition;
        let property = if is_tangent { "tangent" } else { "curvature" };
        let split = match joint.continuity {
            Continuity::G0 => true,
            Continuity::G1 => !is_tangent,
            Continuity::G2 => false,
        };
        if sided && !split {
            let message = format!("joint {} has one {property}, not one for each side", quote(&joint.name));
            let help = if is_tangent {
                "the tangent is split by a `G0Joint`"
            } else {
                "the curvature is split by a `G1Joint` or a `G0Joint`"
            };
            return Err(Fault::error(self.text, place, message).help(help));
        }
        let given = if is_tangent { &mut joint.tangent } else { &mut joint.curvature };
        let places = &mut seen.places[usize::from(is_tangent)];
        for side in 0..2 {
            if sides[side] {
                if let Some(first) = places[side] {
                    let message = format!("the {property} of joint {} is given twice", quote(&joint.name));
                    return Err(Fault::error(self.text, place, message).earlier(
                        self.text,
                        first,
                        "given here",
                    ));
                }
                places[side] = Some(place);
                match value {
                    Value::Given(value) => given[side] = value,
                    Value::Size(size) => seen.sizes[side] = Some(size),
                }
            }
        }
        Ok(())
    }

    /// Curvatures of which only the size is given: along the tangent, which says nothing of their direction.
    fn turn_sizes(&self, joint: &mut NamedJoint, seen: &Seen) -> Parsed<()> {
        for side in 0..2 {
            let (Some(size), Some(place)) = (seen.sizes[side], seen.places[0][side]) else { continue };
            let (Given::Fixed(tangent) | Given::Initial(tangent)) = joint.tangent[side] else {
                let name = quote(&joint.name);
                let message =
                    format!("the curvature of joint {name} has a size but the joint has no tangent");
                return Err(Fault::error(self.text, place, message)
                    .help("give a tangent, fixed or initial, or a vector: `(Size Curvature (x,y,z))`"));
            };
            // Any length is a direction: no square may overflow.
            let most = tangent.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            let tangent = tangent.map(|x| x / most);
            let length = tangent.iter().map(|x| x * x).sum::<f64>().sqrt();
            joint.curvature[side] = Given::Size(tangent.map(|x| size * (x / length)));
        }
        Ok(())
    }

    /// The `)` of a condition.
    fn close(&mut self, open: Word<'a>, what: &str) -> Parsed<()> {
        let word = self.words.next();
        match word.kind {
            Kind::Close => Ok(()),
            Kind::End => Err(self.unclosed(open, what)),
            _ => Err(self.expected("`)` after the value", word)),
        }
    }

    /// `name Open | Closed (a,b,…) )` after its keyword.
    fn curve(&mut self, open: Word<'a>) -> Parsed<Curve<'a>> {
        let name = self.name(open, "curve")?;
        let what = format!("curve {}", quote(name.text));
        let kind = self.words.next();
        let closed = match kind.text.to_ascii_lowercase().as_str() {
            "open" => false,
            "closed" => true,
            _ if kind.kind == Kind::End => return Err(self.unclosed(open, &what)),
            _ => {
                let fault = self.expected(&format!("`Open` or `Closed` after the name of {what}"), kind);
                return Err(match did_you_mean(kind.text, ["Open", "Closed"]) {
                    Some(help) if kind.kind == Kind::Text => fault.help(help),
                    _ => fault,
                });
            }
        };

        let list = self.words.next();
        match list.kind {
            Kind::Open => {}
            Kind::End => return Err(self.unclosed(open, &what)),
            _ => return Err(self.expected(&format!("the joints `(a,b,…)` of {what}"), list)),
        }
        let mut joints = Vec::new();
        loop {
            let word = self.words.next();
            match word.kind {
                Kind::Text => joints.push(word),
                Kind::Close if joints.is_empty() => break,
                Kind::End => return Err(self.unclosed(list, &format!("the joints of {what}"))),
                _ => return Err(self.expected("the name of a joint", word)),
            }
            let word = self.words.next();
            match word.kind {
                Kind::Comma => {}
                Kind::Close => break,
                Kind::End => return Err(self.unclosed(list, &format!("the joints of {what}"))),
                _ => return Err(self.expected("`,` or `)` after the name of a joint", word)),
            }
        }
        let close = self.words.next();
        match close.kind {
            Kind::Close => Ok(Curve { place: open.place.to(name.place), name: name.text, closed, joints }),
            Kind::End => Err(self.unclosed(open, &what)),
            _ => Err(self.expected(&format!("the `)` of {what}"), close)),
        }
    }
}

pub(super) fn describe(word: Word<'_>) -> String {
    match word.kind {
        Kind::End => "the end of the file".to_owned(),
        _ => quote(word.text),
    }
}

/// Whether a form begins with this word.
pub(super) fn is_head(word: Word<'_>) -> bool {
    is_any(word.text, &HEADS)
}

fn heads() -> String {
    let [others @ .., last] = HEADS;
    format!("{} or {last}", others.join(", "))
}

fn is_any(word: &str, keywords: &[&str]) -> bool {
    keywords.iter().any(|keyword| word.eq_ignore_ascii_case(keyword))
}

pub(super) fn looks_like_number(word: &str) -> bool {
    word.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
}
