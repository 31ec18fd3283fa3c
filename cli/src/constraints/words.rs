//! Words and parentheses of the constraint format, and where they stand.

/// Where something stands in the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    /// The first byte.
    pub(super) start: usize,
    /// The byte after the last.
    pub(super) end: usize,
    /// The line of the first byte, from 1.
    pub(super) line: usize,
    /// The column of the first byte in characters, from 1.
    pub(super) column: usize,
}

impl Place {
    /// From here to the end of `last`.
    pub(super) fn to(self, last: Self) -> Self {
        Self { end: last.end, ..self }
    }
}

/// What kind a word is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// `(`
    Open,
    /// `)`
    Close,
    /// `,`
    Comma,
    /// A keyword, name or number.
    Text,
    /// The end of the file.
    End,
}

/// One word of the text.
#[derive(Clone, Copy, Debug)]
pub(super) struct Word<'a> {
    pub(super) kind: Kind,
    pub(super) text: &'a str,
    pub(super) place: Place,
}

/// The words of a text, one after another, and after them `End` for ever.
#[derive(Clone, Debug)]
pub(super) struct Words<'a> {
    text: &'a str,
    at: usize,
    line: usize,
    column: usize,
}

impl<'a> Words<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { text, at: 0, line: 1, column: 1 }
    }

    /// The next word.
    pub(super) fn next(&mut self) -> Word<'a> {
        self.skip_blank();
        let (start, line, column) = (self.at, self.line, self.column);
        let kind = match self.peek() {
            None => Kind::End,
            Some('(') => self.single(Kind::Open),
            Some(')') => self.single(Kind::Close),
            Some(',') => self.single(Kind::Comma),
            Some(_) => {
                while self.peek().is_some_and(|c| !c.is_whitespace() && !"(),;#".contains(c)) {
                    self.step();
                }
                Kind::Text
            }
        };
        let place = Place { start, end: self.at, line, column };
        Word { kind, text: &self.text[start..self.at], place }
    }

    fn single(&mut self, kind: Kind) -> Kind {
        self.step();
        kind
    }

    fn skip_blank(&mut self) {
        while let Some(c) = self.peek() {
            if c == ';' || c == '#' {
                while self.peek().is_some_and(|c| c != '\n' && c != '\r') {
                    self.step();
                }
            } else if c.is_whitespace() {
                self.step();
            } else {
                return;
            }
        }
    }

    fn peek(&self) -> Option<char> {
        self.text[self.at..].chars().next()
    }

    /// Passes one character. A line ends with LF, CR LF or a lone CR.
    fn step(&mut self) {
        let Some(c) = self.peek() else { return };
        self.at += c.len_utf8();
        if c == '\n' || (c == '\r' && self.peek() != Some('\n')) {
            self.line += 1;
            self.column = 1;
        } else {
            self.column += 1;
        }
    }
}

/// The place of the character at a byte, found by reading from the start.
pub(super) fn place_of(text: &str, byte: usize) -> Place {
    place_when(text, |words| words.at >= byte)
}

/// The place of the character at a line and column.
pub(super) fn place_at(text: &str, line: usize, column: usize) -> Place {
    place_when(text, |words| (words.line, words.column) >= (line, column))
}

fn place_when(text: &str, reached: impl Fn(&Words<'_>) -> bool) -> Place {
    let mut words = Words::new(text);
    while words.at < text.len() && !reached(&words) {
        words.step();
    }
    let (start, line, column) = (words.at, words.line, words.column);
    words.step();
    Place { start, end: words.at, line, column }
}
