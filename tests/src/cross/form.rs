//! Parentheses and words: as much of the thesis's format as well-formed files need.
//!
//! The command has a reader that explains every mistake. This one, apart from it, knows only what is right.

/// A word, or a list in parentheses.
#[derive(Clone, Debug, PartialEq)]
pub enum Form {
    /// A keyword, a name or a number.
    Word(String),
    /// What stands in a pair of parentheses.
    List(Vec<Form>),
}

impl Form {
    /// The word in lower case; empty for a list.
    pub fn keyword(&self) -> String {
        match self {
            Self::Word(word) => word.to_ascii_lowercase(),
            Self::List(_) => String::new(),
        }
    }

    /// What is in the parentheses; nothing for a word.
    pub fn inner(&self) -> &[Self] {
        match self {
            Self::Word(_) => &[],
            Self::List(forms) => forms,
        }
    }

    /// The three numbers of a point.
    ///
    /// # Panics
    ///
    /// If this is no point.
    pub fn point(&self) -> [f64; 3] {
        let [x, y, z] = self.inner() else { panic!("{self:?} is no point") };
        [x, y, z].map(Self::number)
    }

    /// The number that a word is.
    ///
    /// # Panics
    ///
    /// If it is none.
    pub fn number(&self) -> f64 {
        self.keyword().parse().unwrap_or_else(|_| panic!("{self:?} is no number"))
    }
}

/// The forms of a file, comments left out.
///
/// # Panics
///
/// Where parentheses do not match.
pub fn forms(text: &str) -> Vec<Form> {
    let mut open = vec![Vec::new()];
    for line in text.lines() {
        let line = line.split([';', '#']).next().unwrap_or_default();
        let spaced = line.replace('(', " ( ").replace(')', " ) ").replace(',', " ");
        for word in spaced.split_whitespace() {
            match word {
                "(" => open.push(Vec::new()),
                ")" => {
                    let list = open.pop().expect("there is always a list");
                    open.last_mut().expect("a `)` without its `(`").push(Form::List(list));
                }
                _ => {
                    open.last_mut().expect("there is always a list").push(Form::Word(word.to_owned()));
                }
            }
        }
    }
    assert!(open.len() == 1, "a `(` without its `)`");
    open.pop().expect("there is always a list")
}
