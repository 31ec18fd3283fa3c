//! From words to joints and a curve as they are written.

use super::fault::{did_you_mean, quote};
use super::resolve::{Curve, Joint, Written};
use super::words::{Kind, Place, Word, Words};
use super::{Continuity, Fault, Given, NamedJoint};

pub(super) type Parsed<T> = Result<T, Box<Fault>>;

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
    value: Given,
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

    fn stray(&self, word: Word<'_>) -> Box<Fault> {
        let fault = self.expected("`(` to begin a joint or a curve", word);
        match word.text {
            "-" | "*" | "•" => fault.help("list markers are not part of the format: take it away"),
            _ => fault.help("a comment begins with `;` or `#`"),
        }
    }

    fn unknown_head(&self, open: Word<'_>, head: Word<'_>) -> Box<Fault> {
        const HEADS: [&str; 4] = ["G2Joint", "G1Joint", "G0Joint", "G2Curve"];
        match head.kind {
            Kind::End => self.unclosed(open, "this form"),
            Kind::Text => {
                let fault = self.fault(head, format!("unknown keyword {}", quote(head.text)));
                match head.text.to_ascii_lowercase().as_str() {
                    "g0curve" | "g1curve" => fault
                        .help("a curve is always `G2Curve`; its joints say what is continuous (`G1Joint`, `G0Joint`)"),
                    _ => fault.help(
                        did_you_mean(head.text, HEADS)
                            .unwrap_or("a form begins with G2Joint, G1Joint, G0Joint or G2Curve".to_owned()),
                    ),
                }
            }
            _ => self.expected("G2Joint, G1Joint, G0Joint or G2Curve", head),
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
        let mut seen = [[None; 2]; 2];
        loop {
            let word = self.words.next();
            match word.kind {
                Kind::Close => return Ok(Joint { place: open.place.to(name.place), value: joint }),
                Kind::End => return Err(self.unclosed(open, &what)),
                Kind::Open => {}
                Kind::Comma | Kind::Text => {
                    return Err(
                        self.expected(&format!("`(Fixed …`, `(Initial …` or the `)` of {what}"), word)
                    );
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

    /// `[index] [Fixed | Initial] (x,y,z)`
    fn position(&mut self, open: Word<'a>, what: &str) -> Parsed<Given> {
        let mut word = self.words.next();
        if word.kind == Kind::Text && word.text.bytes().all(|b| b.is_ascii_digit()) {
            word = self.words.next();
        }
        let mut initial = false;
        if word.kind == Kind::Text {
            initial = match word.text.to_ascii_lowercase().as_str() {
                "fixed" => false,
                "initial" => true,
                _ if looks_like_number(word.text) => {
                    let message =
                        format!("the index of {what} must be a whole number, not {}", quote(word.text));
                    return Err(self
                        .fault(word, message)
                        .help("a position stands in parentheses: `(x,y,z)`"));
                }
                _ => {
                    let fault = self.expected(&format!("the position of {what}"), word);
                    return Err(match did_you_mean(word.text, ["Fixed", "Initial"]) {
                        Some(help) => fault.help(help),
                        None => fault,
                    });
                }
            };
            word = self.words.next();
        }
        match word.kind {
            Kind::Close => return Err(self.fault(word, format!("{what} has no position"))),
            Kind::End => return Err(self.unclosed(open, what)),
            _ => {}
        }
        let (point, _) = self.point(open, word, what, "the position")?;
        Ok(if initial { Given::Initial(point) } else { Given::Fixed(point) })
    }

    /// `Fixed | Initial  Tangent | Curvature  [Arriving | Leaving]  (x,y,z) )` after its parenthesis.
    fn condition(&mut self, open: Word<'a>, inner: Word<'a>, what: &str) -> Parsed<Condition> {
        let status = self.words.next();
        let initial = match status.text.to_ascii_lowercase().as_str() {
            "fixed" => false,
            "initial" => true,
            "g0joint" | "g1joint" | "g2joint" | "g2curve" => {
                let message = format!("a `)` is missing before this form: {what} is still open");
                return Err(self.fault(inner, message).earlier(self.text, open.place, "it begins here"));
            }
            lower => {
                let fault = match status.kind {
                    Kind::End => return Err(self.unclosed(open, what)),
                    Kind::Text => {
                        self.fault(status, format!("unknown keyword {} in {what}", quote(status.text)))
                    }
                    _ => self.expected("`Fixed` or `Initial`", status),
                };
                return Err(match did_you_mean(status.text, ["Fixed", "Initial"]) {
                    _ if lower == "tangent" || lower == "curvature" => {
                        fault.help(format!("say which: `(Fixed {0} …` or `(Initial {0} …`", status.text))
                    }
                    Some(help) if status.kind == Kind::Text => fault.help(help),
                    _ => fault.help("a condition is `(Fixed Tangent (x,y,z))`, or Initial, or Curvature"),
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

        let mut word = self.words.next();
        let mut sides = [true, true];
        let sided = word.kind == Kind::Text;
        if sided {
            sides = match word.text.to_ascii_lowercase().as_str() {
                "arriving" => [true, false],
                "leaving" => [false, true],
                _ => {
                    let fault = self.expected(&format!("the value of {property_name} of {what}"), word);
                    return Err(match did_you_mean(word.text, ["Arriving", "Leaving"]) {
                        Some(help) => fault.help(help),
                        None => fault.help("a value stands in parentheses: `(x,y,z)`"),
                    });
                }
            };
            word = self.words.next();
        }
        if word.kind == Kind::Close {
            return Err(self.fault(word, format!("{property_name} of {what} has no value")));
        }
        let (point, place) = self.point(open, word, what, property_name)?;
        if is_tangent && point == [0.0; 3] {
            let message = format!("the tangent of {what} has no direction: all coordinates are zero");
            return Err(Fault::error(self.text, place, message));
        }
        self.close(open, what)?;
        let value = if initial { Given::Initial(point) } else { Given::Fixed(point) };
        Ok(Condition { place: inner.place.to(property.place), is_tangent, sides, sided, value })
    }

    /// Writes a condition into its joint, once a side.
    fn apply(
        &self,
        condition: Condition,
        joint: &mut NamedJoint,
        seen: &mut [[Option<Place>; 2]; 2],
    ) -> Parsed<()> {
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
        let seen = &mut seen[usize::from(is_tangent)];
        for side in 0..2 {
            if sides[side] {
                if let Some(first) = seen[side] {
                    let message = format!("the {property} of joint {} is given twice", quote(&joint.name));
                    return Err(Fault::error(self.text, place, message).earlier(
                        self.text,
                        first,
                        "given here",
                    ));
                }
                seen[side] = Some(place);
                given[side] = value;
            }
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

fn describe(word: Word<'_>) -> String {
    match word.kind {
        Kind::End => "the end of the file".to_owned(),
        _ => quote(word.text),
    }
}

fn is_any(word: &str, keywords: &[&str]) -> bool {
    keywords.iter().any(|keyword| word.eq_ignore_ascii_case(keyword))
}

fn looks_like_number(word: &str) -> bool {
    word.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
}
