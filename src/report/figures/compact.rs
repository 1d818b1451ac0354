//! Rectangles of an SVG written briefly: thousands of them make a region map.

/// The same drawing with every filled rectangle as a path, neighbours of one colour as one path.
pub(super) fn rectangles(svg: &str) -> String {
    let mut out = String::with_capacity(svg.len());
    let mut open: Option<&str> = None;
    for line in svg.split_inclusive('\n') {
        let Some((fill, corners)) = rectangle(line) else {
            close(&mut out, &mut open);
            out.push_str(line);
            continue;
        };
        if open != Some(fill) {
            close(&mut out, &mut open);
            out.push_str(&format!("<path fill=\"{fill}\" d=\""));
            open = Some(fill);
        }
        let [left, top, right, bottom] = corners;
        let (width, height) = (right - left, bottom - top);
        out.push_str(&format!("M{left} {top}h{width}v{height}h{}z", -width));
    }
    close(&mut out, &mut open);
    out
}

fn close(out: &mut String, open: &mut Option<&str>) {
    if open.take().is_some() {
        out.push_str("\"/>\n");
    }
}

/// Fill and corners (left, top, right, bottom) of a line that is a filled rectangle.
fn rectangle(line: &str) -> Option<(&str, [i32; 4])> {
    let rest = line.strip_prefix("<polygon fill=\"")?;
    let (fill, rest) = rest.split_once("\" points=\"")?;
    let points = rest.strip_suffix(" \"/>\n")?;
    let mut corners = [(0, 0); 4];
    let mut count = 0;
    for point in points.split(' ') {
        let (x, y) = point.split_once(',')?;
        *corners.get_mut(count)? = (x.parse().ok()?, y.parse().ok()?);
        count += 1;
    }
    let [a, b, c, d] = corners;
    let upright = a.1 == b.1 && b.0 == c.0 && c.1 == d.1 && d.0 == a.0;
    // all turn the same way, so that where they overlap nothing is cut out
    (count == 4 && upright && b.0 > a.0 && c.1 > b.1).then_some((fill, [a.0, a.1, c.0, c.1]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_of_one_colour_become_one_path() {
        let svg = "<svg>\n\
            <polygon fill=\"#aa0000\" points=\"0,0 4,0 4,2 0,2 \"/>\n\
            <polygon fill=\"#aa0000\" points=\"4,0 6,0 6,2 4,2 \"/>\n\
            <polygon fill=\"#00bb00\" points=\"0,0 4,0 4,2 0,2 \"/>\n\
            <polygon fill=\"#00bb00\" points=\"0,0 4,0 3,2 0,2 \"/>\n</svg>";
        let short = "<svg>\n\
            <path fill=\"#aa0000\" d=\"M0 0h4v2h-4zM4 0h2v2h-2z\"/>\n\
            <path fill=\"#00bb00\" d=\"M0 0h4v2h-4z\"/>\n\
            <polygon fill=\"#00bb00\" points=\"0,0 4,0 3,2 0,2 \"/>\n</svg>";
        assert_eq!(rectangles(svg), short);
    }
}
