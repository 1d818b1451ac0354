//! A part of the terminal that is drawn again; in a pipe, its texts one after the other.

use std::io::{IsTerminal, Write};

use super::failure::print_diagnostics;
use super::speech::Speech;
use super::{Failure, Verbosity};
use impact_campaign::campaign::diagnostic::Diagnostics;

/// Whether a terminal obeys the sequences that move its cursor; on Windows they are switched on, which consoles before
/// Windows 10 cannot.
fn moves_the_cursor() -> bool {
    anstyle_query::windows::enable_ansi_colors().unwrap_or(true)
}

/// The part at the end of the standard error stream that is drawn again.
#[derive(Debug)]
pub(super) struct Screen {
    verbosity: Verbosity,
    is_terminal: bool,
    /// What is drawn now.
    drawn: String,
    /// Whether a line is below it that says what is being done.
    is_busy: bool,
}

impl Screen {
    /// Nothing is drawn. A console that draws nothing again is as a pipe.
    pub(super) fn new(verbosity: Verbosity) -> Self {
        Self {
            verbosity,
            is_terminal: std::io::stderr().is_terminal() && moves_the_cursor(),
            drawn: String::new(),
            is_busy: false,
        }
    }

    /// A line that stays, above what is drawn.
    pub(super) fn say(&mut self, text: &str) {
        self.above(|screen| screen.verbosity.info(text));
    }

    /// Problems, which stay.
    pub(super) fn problems(&mut self, all: &Diagnostics, speech: &Speech) {
        self.above(|screen| print_diagnostics(all, speech.words().as_ref(), screen.verbosity));
    }

    /// What could not be done, which stays.
    pub(super) fn fail(&mut self, failure: &Failure) {
        self.above(|screen| failure.print(screen.verbosity));
    }

    /// Draw a text in the place of the one before; in a pipe, only where it is `lasting`.
    pub(super) fn draw(&mut self, text: &str, lasting: bool) {
        if self.verbosity.is_quiet() || (!self.is_terminal && (!lasting || text == self.drawn)) {
            return;
        }
        self.erase();
        self.put_cut(text);
        text.clone_into(&mut self.drawn);
    }

    /// What is being done, below what is drawn; only on a terminal.
    pub(super) fn busy(&mut self, text: &str) {
        if self.is_terminal && !self.verbosity.is_quiet() && !self.is_busy {
            self.put(&format!("{text}\n"));
            self.is_busy = true;
        }
    }

    /// What is drawn stays.
    pub(super) fn leave(&mut self) {
        self.drawn.clear();
        self.is_busy = false;
    }

    fn above(&mut self, print: impl FnOnce(&Self)) {
        self.erase();
        print(self);
        if self.is_terminal {
            self.put_cut(&self.drawn);
        }
    }

    /// Lines that are longer than those of the terminal are cut there: the number of lines must be known.
    fn put_cut(&self, text: &str) {
        if self.is_terminal {
            self.put(&format!("\x1b[?7l{text}\x1b[?7h"));
        } else {
            self.put(text);
        }
    }

    fn put(&self, text: &str) {
        // a terminal that is gone is no fault
        let _ = std::io::stderr().write_all(text.as_bytes());
    }

    /// Remove what is drawn from the terminal.
    fn erase(&mut self) {
        let lines = self.drawn.lines().count() + usize::from(self.is_busy);
        if self.is_terminal && lines > 0 {
            // up, then clear to the end of the screen
            self.put(&format!("\x1b[{lines}A\r\x1b[J"));
        }
        self.is_busy = false;
    }
}
