//! The deepest chain of calls.
//!
//! A call by a pointer is followed to every function that it may mean. Which these are is told by `RULES`: the interfaces
//! that the library calls through are few. A caller or a target that no rule knows is an error, and so is a circle of calls:
//! nothing is bounded by being overlooked.

use super::program::Program;

/// Who calls by pointers, and the ends of the names of what they may call; callers are told by a part of their names.
///
/// What the caller of the C library brings (observers, visitors, writers) is his own, and comes on top.
const RULES: [(&str, &[&str]); 7] = [
    ("core::fmt::write", &["::write_str", "::write_char"]),
    (" as core::fmt::Write>::", &[]),
    ("core::fmt::", &["::write_str", "::write_char", "::write_fmt"]),
    ("minvar::curve::Watch as ", &[]),
    ("minvar::solve::executor::InOrder", &[">>::cost::{closure#0}", ">>::linearise::{closure#0}"]),
    (
        "minvar::solve::",
        &[
            "as minvar::solve::executor::Executor>::run",
            "as minvar::solve::executor::Executor>::width",
            ITERATION,
        ],
    ),
    ("minvar", &[ITERATION]),
];
const ITERATION: &str = "as minvar::solve::report::Observer>::iteration";
/// These call themselves, and at most once: a number too small to be normal is scaled first.
const TWICE: [&str; 1] = ["libm::math::frexp::frexp"];
/// What formats one value. Whoever has the address of such a function hands it to `core::fmt::write`, by one more pointer.
const DISPLAY: &str = "core::fmt::Display>::fmt";
const FORMATTING: [&str; 3] =
    ["core::fmt::write", "core::fmt::Formatter>::write_fmt", "as core::fmt::Write>::write_fmt"];

/// What is known of the deepest chain of calls below a function.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Depth {
    Unknown,
    /// It is just being followed.
    Open,
    /// Bytes, and the next function of the chain.
    Known(u64, Option<usize>),
}

/// The deepest chain of calls below every function.
#[derive(Debug)]
pub struct Bounds<'a> {
    program: &'a Program,
    deepest: Vec<Depth>,
    targets: Vec<Vec<usize>>,
    formatting: Vec<usize>,
}

impl<'a> Bounds<'a> {
    /// Follows every call of a program.
    ///
    /// # Errors
    ///
    /// A call by a pointer, or an address taken, that no rule knows; functions that call each other in a circle.
    pub fn new(program: &'a Program) -> Result<Self, String> {
        let count = program.functions.len();
        let mut taken = program.in_tables.clone();
        taken.extend(program.functions.iter().flat_map(|function| &function.takes));
        let ends = |suffix: &str| -> Vec<usize> {
            let named = |&f: &usize| program.functions[f].names.iter().any(|name| name.ends_with(suffix));
            taken.iter().copied().filter(named).collect()
        };
        let mut targets = Vec::new();
        for function in &program.functions {
            let mut of = Vec::new();
            if function.by_pointer {
                let rule =
                    |(part, _): &&(&str, &[&str])| function.names.iter().any(|name| name.contains(part));
                let (_, suffixes) =
                    RULES.iter().find(rule).ok_or(format!("{:?} calls by a pointer", function.names))?;
                of = suffixes.iter().flat_map(|suffix| ends(suffix)).collect();
            }
            targets.push(of);
        }
        let known: Vec<_> =
            RULES.iter().flat_map(|(_, suffixes)| *suffixes).flat_map(|suffix| ends(suffix)).collect();
        let display = ends(DISPLAY);
        if let Some(&f) = taken.iter().find(|f| !known.contains(f) && !display.contains(f)) {
            return Err(format!("who calls {:?} by its address?", program.functions[f].names));
        }
        if let Some(&f) = display.iter().find(|f| program.in_tables.contains(f)) {
            return Err(format!("{:?} is in a table: who formats with it?", program.functions[f].names));
        }
        let formats = |&f: &usize| {
            program.functions[f]
                .names
                .iter()
                .any(|name| FORMATTING.iter().any(|suffix| name.ends_with(suffix)))
        };
        let formatting = (0..count).filter(formats).collect();
        let mut bounds = Self { program, deepest: vec![Depth::Unknown; count], targets, formatting };
        for f in 0..count {
            bounds.follow(f)?;
        }
        Ok(bounds)
    }

    fn follow(&mut self, f: usize) -> Result<u64, String> {
        match self.deepest[f] {
            Depth::Known(bytes, _) => return Ok(bytes),
            Depth::Open => {
                return Err(format!("{:?} calls itself in the end", self.program.functions[f].names));
            }
            Depth::Unknown => self.deepest[f] = Depth::Open,
        }
        let function = &self.program.functions[f];
        let twice = function.names.iter().any(|name| TWICE.contains(&name.as_str()));
        let frame = if twice { 2 * function.frame } else { function.frame };
        let (mut below, mut next) = (0, None);
        let mut consider = |bytes, g| {
            if bytes > below {
                (below, next) = (bytes, Some(g));
            }
        };
        for g in function.calls.iter().copied().chain(self.targets[f].clone()).filter(|&g| !(twice && g == f))
        {
            consider(self.follow(g)?, g);
        }
        let shows: Vec<_> = function.takes.iter().copied().filter(|&g| self.is_display(g)).collect();
        if !shows.is_empty() {
            let mut between = 0;
            for g in self.formatting.clone() {
                between = self.follow(g)?.max(between);
            }
            for g in shows {
                consider(between + self.follow(g)?, g);
            }
        }
        self.deepest[f] = Depth::Known(frame + below, next);
        Ok(frame + below)
    }

    fn is_display(&self, f: usize) -> bool {
        self.program.functions[f].names.iter().any(|name| name.ends_with(DISPLAY))
    }

    /// The functions of the C library and the bytes of stack that each takes at most.
    pub fn of_the_library(&self) -> Vec<(&'a str, u64)> {
        let names = |f: usize| self.program.functions[f].names.iter().map(move |name| (name.as_str(), f));
        let public = (0..self.deepest.len()).flat_map(names).filter(|(name, _)| name.starts_with("minvar_"));
        public
            .map(|(name, f)| (name, if let Depth::Known(bytes, _) = self.deepest[f] { bytes } else { 0 }))
            .collect()
    }

    /// The deepest chain of calls from a function of the library: frames and names.
    pub fn chain(&self, name: &str) -> Vec<(u64, &'a str)> {
        let mut at = self.program.functions.iter().position(|function| function.names.contains(name));
        let mut chain = Vec::new();
        while let Some(f) = at {
            let function = &self.program.functions[f];
            chain.push((function.frame, function.names.first().map_or("", String::as_str)));
            at = if let Depth::Known(_, next) = self.deepest[f] { next } else { None };
        }
        chain
    }
}

#[cfg(test)]
mod tests {
    use super::super::program::Function;
    use super::*;

    fn function(name: &str, frame: u64, calls: &[usize]) -> Function {
        let names = [name.to_owned()].into();
        Function { names, frame, calls: calls.iter().copied().collect(), ..Function::default() }
    }

    fn program(functions: Vec<Function>) -> Program {
        Program { functions, ..Program::default() }
    }

    #[test]
    fn the_deepest_chain_counts() {
        let functions = vec![
            function("minvar_solve", 8, &[1, 2]),
            function("a", 100, &[2]),
            function("b", 16, &[]),
            function("c", 900, &[]),
        ];
        let program = program(functions);
        let bounds = Bounds::new(&program).unwrap();
        assert_eq!(bounds.of_the_library(), [("minvar_solve", 124)]);
        assert_eq!(bounds.chain("minvar_solve"), [(8, "minvar_solve"), (100, "a"), (16, "b")]);
    }

    #[test]
    fn a_circle_of_calls_has_no_bound() {
        let program =
            program(vec![function("minvar_solve", 8, &[1]), function("a", 8, &[2]), function("b", 8, &[1])]);
        assert_eq!(Bounds::new(&program).unwrap_err(), "{\"a\"} calls itself in the end");
    }

    #[test]
    fn pointers_lead_where_the_rules_say_or_the_program_is_refused() {
        let run = "<minvar::solve::executor::InOrder as minvar::solve::executor::Executor>::run";
        let mut cost = function("<minvar::solve::Run<M>>::cost", 100, &[]);
        cost.by_pointer = true;
        let mut functions = vec![
            cost,
            function(run, 20, &[]),
            function("<minvar::solve::Run<M>>::cost::{closure#0}", 3, &[]),
        ];
        functions[1].by_pointer = true;
        let mut program = program(functions);
        program.in_tables = [1, 2].into();
        assert_eq!(Bounds::new(&program).unwrap().deepest[0], Depth::Known(123, Some(1)));

        program.functions[0].names = ["other::cost".to_owned()].into();
        assert_eq!(Bounds::new(&program).unwrap_err(), "{\"other::cost\"} calls by a pointer");
        program.functions[0].by_pointer = false;
        program.functions[2].names = ["other::closure".to_owned()].into();
        assert_eq!(Bounds::new(&program).unwrap_err(), "who calls {\"other::closure\"} by its address?");
    }

    #[test]
    fn what_formats_a_value_is_reached_through_the_machinery() {
        let shows = "<minvar::Failure as core::fmt::Display>::fmt";
        let mut functions = vec![
            function("minvar_solve", 1, &[]),
            function(shows, 1000, &[]),
            function("core::fmt::write", 50, &[]),
        ];
        functions[0].takes = [1].into();
        assert_eq!(Bounds::new(&program(functions)).unwrap().deepest[0], Depth::Known(1051, Some(1)));
    }
}
