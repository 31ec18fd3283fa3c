//! One thing wrong with a constraint file: where, what, and what may help.

use super::Place;
use annotate_snippets::{
    Annotation, AnnotationKind, Element, Level, Renderer, Snippet, normalize_untrusted_str,
};

/// Whether the file can be used all the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Severity {
    /// It cannot.
    Error,
    /// It can, but perhaps does not say what was meant.
    Warning,
}

/// What is wrong, with the lines of the file that show it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// How bad it is.
    severity: Severity,
    /// One sentence naming the culprit.
    pub message: String,
    /// The line, from 1.
    pub line: usize,
    /// The column in characters, from 1.
    pub column: usize,
    /// What to do about it.
    pub help: Option<String>,
    here: Excerpt,
    earlier: Option<(Excerpt, &'static str)>,
}

/// A line of the file and the bytes of it that matter.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Excerpt {
    line: usize,
    text: String,
    start: usize,
    end: usize,
}

impl Fault {
    pub(super) fn error(text: &str, place: Place, message: impl Into<String>) -> Box<Self> {
        Self::new(Severity::Error, text, place, message.into())
    }

    pub(super) fn warning(text: &str, place: Place, message: impl Into<String>) -> Box<Self> {
        Self::new(Severity::Warning, text, place, message.into())
    }

    fn new(severity: Severity, text: &str, place: Place, message: String) -> Box<Self> {
        let Place { line, column, .. } = place;
        let here = Excerpt::new(text, place);
        Box::new(Self { severity, message, line, column, help: None, here, earlier: None })
    }

    pub(super) fn help(mut self: Box<Self>, help: impl Into<String>) -> Box<Self> {
        self.help = Some(help.into());
        self
    }

    /// Shows an earlier place too.
    pub(super) fn earlier(mut self: Box<Self>, text: &str, place: Place, label: &'static str) -> Box<Self> {
        self.earlier = Some((Excerpt::new(text, place), label));
        self
    }

    /// The message with its lines, as a compiler would print it. With colours only if asked for.
    pub fn render(&self, file: &str, colours: bool) -> String {
        let level = match self.severity {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
        };
        let mut group = level
            .primary_title(normalize_untrusted_str(&self.message))
            .element(self.here.snippet(file, AnnotationKind::Primary, None));
        if let Some((excerpt, label)) = &self.earlier {
            group = group.element(excerpt.snippet(file, AnnotationKind::Context, Some(label)));
        }
        if let Some(help) = &self.help {
            group = group.element(Element::from(Level::HELP.message(normalize_untrusted_str(help))));
        }
        let renderer = if colours { Renderer::styled() } else { Renderer::plain() };
        renderer.render(&[group])
    }
}

impl Excerpt {
    /// The line at a place; a place of several lines is cut at the end of the first.
    fn new(text: &str, place: Place) -> Self {
        let is_end = |c| c == '\n' || c == '\r';
        let first = text[..place.start].rfind(is_end).map_or(0, |end| end + 1);
        let last = text[place.start..].find(is_end).map_or(text.len(), |end| place.start + end);
        Self {
            line: place.line,
            text: text[first..last].to_owned(),
            start: place.start - first,
            end: place.end.min(last) - first,
        }
    }

    fn snippet<'a>(
        &'a self,
        file: &'a str,
        kind: AnnotationKind,
        label: Option<&'a str>,
    ) -> Snippet<'a, Annotation<'a>> {
        Snippet::source(self.text.as_str())
            .line_start(self.line)
            .path(file)
            .annotation(kind.span(self.start..self.end).label(label))
    }
}

/// A word as a message shows it: in quotes, and not too long.
pub(super) fn quote(word: &str) -> String {
    const MOST: usize = 40;
    match word.char_indices().nth(MOST) {
        Some((cut, _)) => format!("`{}…`", &word[..cut]),
        None => format!("`{word}`"),
    }
}

/// ` Did you mean …?`, if one of the candidates is near.
pub(super) fn did_you_mean<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<String> {
    const LONGEST: usize = 64;
    if word.len() > LONGEST {
        return None;
    }
    let lower = word.to_lowercase();
    candidates
        .into_iter()
        .filter(|candidate| candidate.len() <= LONGEST)
        .map(|candidate| (strsim::osa_distance(&lower, &candidate.to_lowercase()), candidate))
        .filter(|(distance, candidate)| 3 * distance <= candidate.chars().count().max(3))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| format!("did you mean `{candidate}`?"))
}
