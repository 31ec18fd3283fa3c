//! A peer: a program that answers every command with one line, so that it can take its turn in a round.

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// A running peer. It ends with its input.
pub struct Peer {
    name: String,
    child: Child,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
}

impl Peer {
    /// Starts a program.
    ///
    /// # Errors
    ///
    /// If it cannot be started.
    pub fn start(directory: &Path, name: &str) -> Result<Self, String> {
        let program = directory.join(name);
        let mut child = Command::new(&program)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(|error| format!("the peer {} cannot be started: {error}", program.display()))?;
        let input = child.stdin.take();
        let output = child.stdout.take().ok_or("a peer without output")?;
        Ok(Self { name: name.into(), child, input, output: BufReader::new(output) })
    }

    /// Sends a command and waits for the answer.
    ///
    /// # Errors
    ///
    /// If the peer has ended, with what it was asked.
    pub fn ask(&mut self, command: &str) -> Result<String, String> {
        let what = || command.lines().next().unwrap_or_default().to_owned();
        let input = self.input.as_mut().ok_or("a peer without input")?;
        writeln!(input, "{}", command.trim_end())
            .and_then(|()| input.flush())
            .map_err(|error| format!("{}: {error}, asked for {}", self.name, what()))?;
        let mut line = String::new();
        match self.output.read_line(&mut line) {
            Ok(n) if n > 0 => Ok(line.trim().to_owned()),
            _ => Err(format!("{} ended, asked for {}", self.name, what())),
        }
    }

    /// As [`Self::ask`], for an answer of numbers.
    ///
    /// # Errors
    ///
    /// If the peer has ended, or answers otherwise.
    pub fn numbers(&mut self, command: &str) -> Result<Vec<f64>, String> {
        let answer = self.ask(command)?;
        answer
            .split_whitespace()
            .map(|word| word.parse().map_err(|_| format!("{}: `{word}` is no number", self.name)))
            .collect()
    }
}

impl Drop for Peer {
    fn drop(&mut self) {
        self.input = None;
        let _ = self.child.wait();
    }
}
