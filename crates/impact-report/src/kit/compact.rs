//! Marks of an SVG written briefly: thousands of rectangles make a region map, thousands of dots and short
//! lines what was measured.

use std::fmt::{self, Display, Formatter, Write};

use super::drawing::twice_the_area;

/// The same drawing with neighbours of one kind and look as one path: filled polygons, dots and lines.
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

    /// Write the marks; one alone stays as it is.
    fn close(&mut self, out: &mut String) {
        let Some(look) = self.look.take() else {
            return;
        };
        if self.count == 1 {
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
    Area {
        fill: &'a str,
    },
    /// A line without length whose ends are round.
    Dot {
        fill: &'a str,
        radius: i32,
    },
    Ring {
        stroke: &'a str,
        width: &'a str,
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
            Self::Area { fill } => write!(f, "fill=\"{fill}\""),
            Self::Dot { fill, radius } => write!(
                f,
                "fill=\"none\" stroke=\"{fill}\" stroke-width=\"{}\" stroke-linecap=\"round\"",
                2 * radius
            ),
            Self::Ring { stroke, width, .. } | Self::Line { stroke, width } => {
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
        polygon(line)
            .or_else(|| circle(line))
            .or_else(|| polyline(line))
    }

    /// Append the mark to a path, all but its first point relative to the one before.
    fn draw(&self, path: &mut String) {
        let Some(((x, y), rest)) = self.points.split_first() else {
            return;
        };
        if let Look::Ring { radius: r, .. } = self.look {
            // a string cannot fail to be written
            let _ = write!(path, "M{} {y}", x - r);
            let across = 2 * r;
            let _ = write!(path, "a{r} {r} 0 0 1 {across} 0a{r} {r} 0 0 1 -{across} 0z");
            return;
        }
        // a string cannot fail to be written
        let _ = write!(path, "M{x} {y}");
        let mut before = (*x, *y);
        for point in rest {
            let _ = match (point.0 - before.0, point.1 - before.1) {
                (across, 0) => write!(path, "h{across}"),
                (0, down) => write!(path, "v{down}"),
                (across, down) => write!(path, "l{across} {down}"),
            };
            before = *point;
        }
        match self.look {
            Look::Area { .. } => path.push('z'),
            Look::Dot { .. } => path.push_str("h0"),
            Look::Ring { .. } | Look::Line { .. } => {}
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

/// A filled polygon. All turn the same way, so that where two overlap nothing is cut out.
fn polygon(line: &str) -> Option<Mark<'_>> {
    let rest = line.strip_prefix("<polygon fill=\"")?;
    let (fill, rest) = rest.split_once("\" points=\"")?;
    let mut points = points(rest.strip_suffix(" \"/>\n")?)?;
    if twice_the_area(&points) < 0 {
        points.reverse();
    }
    Some(Mark {
        look: Look::Area { fill },
        points,
    })
}

/// A filled disc, or a circle.
fn circle(line: &str) -> Option<Mark<'_>> {
    let rest = line.strip_prefix("<circle cx=\"")?;
    let (x, rest) = rest.split_once("\" cy=\"")?;
    let (y, rest) = rest.split_once("\" r=\"")?;
    let (radius, rest) = rest.split_once("\" fill=\"")?;
    let (fill, rest) = rest.split_once("\" stroke=\"")?;
    let (stroke, rest) = rest.split_once("\" stroke-width=\"")?;
    let width = rest.strip_suffix("\"/>\n")?;
    let radius = radius.parse().ok()?;
    let look = match (fill, stroke) {
        ("none", _) => Look::Ring {
            stroke,
            width,
            radius,
        },
        (_, "none") => Look::Dot { fill, radius },
        _ => return None,
    };
    Some(Mark {
        look,
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
            <polygon fill=\"#aa0000\" points=\"4,2 6,0 4,0 \"/>\n\
            <polygon fill=\"#00bb00\" points=\"0,0 4,0 3,2 0,2 \"/>\n\
            <circle cx=\"7\" cy=\"8\" r=\"3\" fill=\"#00bb00\" stroke=\"none\" stroke-width=\"1\"/>\n\
            <circle cx=\"9\" cy=\"8\" r=\"3\" fill=\"#00bb00\" stroke=\"none\" stroke-width=\"1\"/>\n\
            <circle cx=\"9\" cy=\"8\" r=\"4\" fill=\"#00bb00\" stroke=\"none\" stroke-width=\"1\"/>\n\
            <circle cx=\"9\" cy=\"8\" r=\"4\" fill=\"none\" stroke=\"#00bb00\" stroke-width=\"2\"/>\n\
            <circle cx=\"9\" cy=\"5\" r=\"4\" fill=\"none\" stroke=\"#00bb00\" stroke-width=\"2\"/>\n\
            <polyline fill=\"none\" stroke=\"#00bb00\" stroke-width=\"6\" points=\"1,1 3,2 3,9 \"/>\n\
            <polyline fill=\"none\" stroke=\"#00bb00\" stroke-width=\"6\" points=\"5,5 4,4 \"/>\n\
            <polyline fill=\"none\" stroke=\"#00bb00\" stroke-width=\"7\" points=\"5,5 4,4 \"/>\n</svg>";
        let short = "<svg>\n\
            <path fill=\"#aa0000\" d=\"M0 0h4v2h-4zM4 0h2l-2 2z\"/>\n\
            <polygon fill=\"#00bb00\" points=\"0,0 4,0 3,2 0,2 \"/>\n\
            <path fill=\"none\" stroke=\"#00bb00\" stroke-width=\"6\" stroke-linecap=\"round\" d=\"M7 8h0M9 8h0\"/>\n\
            <circle cx=\"9\" cy=\"8\" r=\"4\" fill=\"#00bb00\" stroke=\"none\" stroke-width=\"1\"/>\n\
            <path fill=\"none\" stroke=\"#00bb00\" stroke-width=\"2\" \
                d=\"M5 8a4 4 0 0 1 8 0a4 4 0 0 1 -8 0zM5 5a4 4 0 0 1 8 0a4 4 0 0 1 -8 0z\"/>\n\
            <path fill=\"none\" stroke=\"#00bb00\" stroke-width=\"6\" d=\"M1 1l2 1v7M5 5l-1 -1\"/>\n\
            <polyline fill=\"none\" stroke=\"#00bb00\" stroke-width=\"7\" points=\"5,5 4,4 \"/>\n</svg>";
        assert_eq!(marks(svg), short);
    }
}
