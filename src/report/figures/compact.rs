//! Marks of an SVG written briefly: thousands of rectangles make a region map, thousands of dots and short
//! lines what was measured.

use std::fmt::{self, Display, Formatter, Write};

/// The same drawing with neighbours of one kind and look as one path: filled rectangles, dots and lines.
pub(super) fn marks(svg: &str) -> String {
    let mut out = String::with_capacity(svg.len());
    let mut run = Run::default();
    for line in svg.split_inclusive('\n') {
        match Mark::of(line) {
            Some(mark) => run.add(&mut out, line, &mark),
            None => {
                run.close(&mut out);
                out.push_str(line);
            }
        }
    }
    run.close(&mut out);
    out
}

/// Marks of one look, one after the other.
#[derive(Default)]
struct Run<'a> {
    look: Option<Look<'a>>,
    /// The first of them as it was, and how many there are.
    first: &'a str,
    count: usize,
    path: String,
}

impl<'a> Run<'a> {
    fn add(&mut self, out: &mut String, line: &'a str, mark: &Mark<'a>) {
        if self.look != Some(mark.look) {
            self.close(out);
            self.look = Some(mark.look);
            self.first = line;
        }
        self.count += 1;
        mark.draw(&mut self.path);
    }

    /// Write the marks; a dot or a line alone stays as it is.
    fn close(&mut self, out: &mut String) {
        let Some(look) = self.look.take() else {
            return;
        };
        if self.count == 1 && !matches!(look, Look::Rectangle { .. }) {
            out.push_str(self.first);
        } else {
            out.push_str(&format!("<path {look} d=\"{}\"/>\n", self.path));
        }
        self.path.clear();
        self.count = 0;
    }
}

/// What neighbours must have in common.
#[derive(Clone, Copy, PartialEq)]
enum Look<'a> {
    Rectangle {
        fill: &'a str,
    },
    /// A line without length whose ends are round.
    Dot {
        fill: &'a str,
        radius: i32,
    },
    Line {
        stroke: &'a str,
        width: &'a str,
    },
}

impl Display for Look<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rectangle { fill } => write!(f, "fill=\"{fill}\""),
            Self::Dot { fill, radius } => write!(
                f,
                "fill=\"none\" stroke=\"{fill}\" stroke-width=\"{}\" stroke-linecap=\"round\"",
                2 * radius
            ),
            Self::Line { stroke, width } => {
                write!(
                    f,
                    "fill=\"none\" stroke=\"{stroke}\" stroke-width=\"{width}\""
                )
            }
        }
    }
}

/// A mark with its points.
struct Mark<'a> {
    look: Look<'a>,
    points: Vec<(i32, i32)>,
}

impl<'a> Mark<'a> {
    fn of(line: &'a str) -> Option<Self> {
        rectangle(line)
            .or_else(|| dot(line))
            .or_else(|| polyline(line))
    }

    /// Append the mark to a path, all but its first point relative to the one before.
    fn draw(&self, path: &mut String) {
        let Some(((x, y), rest)) = self.points.split_first() else {
            return;
        };
        // a string cannot fail to be written
        let _ = write!(path, "M{x} {y}");
        match (self.look, rest) {
            (Look::Rectangle { .. }, [corner, ..]) => {
                let (width, height) = (corner.0 - x, corner.1 - y);
                let _ = write!(path, "h{width}v{height}h{}z", -width);
            }
            (Look::Dot { .. }, _) => path.push_str("h0"),
            _ => {
                let mut before = (*x, *y);
                for point in rest {
                    let _ = write!(path, "l{} {}", point.0 - before.0, point.1 - before.1);
                    before = *point;
                }
            }
        }
    }
}

/// The points of a line's list.
fn points(list: &str) -> Option<Vec<(i32, i32)>> {
    let point = |point: &str| {
        let (x, y) = point.split_once(',')?;
        Some((x.parse().ok()?, y.parse().ok()?))
    };
    list.split(' ').map(point).collect()
}

/// A filled rectangle: its upper left and its lower right corner.
fn rectangle(line: &str) -> Option<Mark<'_>> {
    let rest = line.strip_prefix("<polygon fill=\"")?;
    let (fill, rest) = rest.split_once("\" points=\"")?;
    let [a, b, c, d] = points(rest.strip_suffix(" \"/>\n")?)?.try_into().ok()?;
    let upright = a.1 == b.1 && b.0 == c.0 && c.1 == d.1 && d.0 == a.0;
    // all turn the same way, so that where they overlap nothing is cut out
    (upright && b.0 > a.0 && c.1 > b.1).then_some(Mark {
        look: Look::Rectangle { fill },
        points: vec![a, c],
    })
}

/// A filled disc.
fn dot(line: &str) -> Option<Mark<'_>> {
    let rest = line.strip_prefix("<circle cx=\"")?;
    let (x, rest) = rest.split_once("\" cy=\"")?;
    let (y, rest) = rest.split_once("\" r=\"")?;
    let (radius, rest) = rest.split_once("\" fill=\"")?;
    let fill = rest.strip_suffix("\" stroke=\"none\" stroke-width=\"1\"/>\n")?;
    Some(Mark {
        look: Look::Dot {
            fill,
            radius: radius.parse().ok()?,
        },
        points: vec![(x.parse().ok()?, y.parse().ok()?)],
    })
}

/// An open line.
fn polyline(line: &str) -> Option<Mark<'_>> {
    let rest = line.strip_prefix("<polyline fill=\"none\" stroke=\"")?;
    let (stroke, rest) = rest.split_once("\" stroke-width=\"")?;
    let (width, rest) = rest.split_once("\" points=\"")?;
    Some(Mark {
        look: Look::Line { stroke, width },
        points: points(rest.strip_suffix(" \"/>\n")?)?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_of_one_look_become_one_path() {
        let svg = "<svg>\n\
            <polygon fill=\"#aa0000\" points=\"0,0 4,0 4,2 0,2 \"/>\n\
            <polygon fill=\"#aa0000\" points=\"4,0 6,0 6,2 4,2 \"/>\n\
            <polygon fill=\"#00bb00\" points=\"0,0 4,0 4,2 0,2 \"/>\n\
            <polygon fill=\"#00bb00\" points=\"0,0 4,0 3,2 0,2 \"/>\n\
            <circle cx=\"7\" cy=\"8\" r=\"3\" fill=\"#00bb00\" stroke=\"none\" stroke-width=\"1\"/>\n\
            <circle cx=\"9\" cy=\"8\" r=\"3\" fill=\"#00bb00\" stroke=\"none\" stroke-width=\"1\"/>\n\
            <circle cx=\"9\" cy=\"8\" r=\"4\" fill=\"#00bb00\" stroke=\"none\" stroke-width=\"1\"/>\n\
            <polyline fill=\"none\" stroke=\"#00bb00\" stroke-width=\"6\" points=\"1,1 3,2 3,9 \"/>\n\
            <polyline fill=\"none\" stroke=\"#00bb00\" stroke-width=\"6\" points=\"5,5 4,4 \"/>\n\
            <polyline fill=\"none\" stroke=\"#00bb00\" stroke-width=\"7\" points=\"5,5 4,4 \"/>\n</svg>";
        let short = "<svg>\n\
            <path fill=\"#aa0000\" d=\"M0 0h4v2h-4zM4 0h2v2h-2z\"/>\n\
            <path fill=\"#00bb00\" d=\"M0 0h4v2h-4z\"/>\n\
            <polygon fill=\"#00bb00\" points=\"0,0 4,0 3,2 0,2 \"/>\n\
            <path fill=\"none\" stroke=\"#00bb00\" stroke-width=\"6\" stroke-linecap=\"round\" d=\"M7 8h0M9 8h0\"/>\n\
            <circle cx=\"9\" cy=\"8\" r=\"4\" fill=\"#00bb00\" stroke=\"none\" stroke-width=\"1\"/>\n\
            <path fill=\"none\" stroke=\"#00bb00\" stroke-width=\"6\" d=\"M1 1l2 1l0 7M5 5l-1 -1\"/>\n\
            <polyline fill=\"none\" stroke=\"#00bb00\" stroke-width=\"7\" points=\"5,5 4,4 \"/>\n</svg>";
        assert_eq!(marks(svg), short);
    }
}
