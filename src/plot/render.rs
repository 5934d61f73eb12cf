//! From a picture to the bytes of its SVG: the one way out of this room.

use super::axis::{Axis, Ticks};
use super::backend::Paper;
use super::colour::{Colour, batlow};
use super::draw::{self, SharedPaper};
use super::error::PlotError;
use super::frame::{AXIS_WIDTH, Frame, LABEL_SIZE, Span, TEXT_SIZE, axis_margins, draw_axes};
use super::label::Label;
use super::layout;
use super::legend;
use super::mark::{Along, At, Side};
use super::picture::{Corner, Inset, Legend, Panel, Picture, Place};
use super::pieces::{self, Pieces, Target, Wish};
use super::place::{self, GAP, SIDES, Scene, Spot};
use super::rect::{Rect, TextBox, TextKind};
use super::svg::{Document, hundredths};
use super::svg_text::{Anchor, TextStyle};
use std::cell::RefCell;
use std::f64::consts::PI;
use std::rc::Rc;

/// The SVG of a picture.
///
/// The same picture gives the same bytes, on every machine. Fails when a coordinate is not finite (NaN lifts the pen of a
/// curve and is allowed there), a range is empty, a logarithm does not exist, or the page is too small.
pub fn render(picture: &Picture) -> Result<Vec<u8>, PlotError> {
    let page = drawn(picture)?;
    Ok(page.finish(&picture.title, &picture.caption, &picture.metadata))
}

/// The SVG of a picture, and the same page as PDF; guarantee and errors as for [`render`], and a character that no font of a PDF has.
pub fn render_both(picture: &Picture) -> Result<(Vec<u8>, Vec<u8>), PlotError> {
    let page = drawn(picture)?;
    Ok((page.finish(&picture.title, &picture.caption, &picture.metadata), page.pdf(&picture.title)?))
}

/// The box of every text of a picture on its page: for tests that no text is cut off or covers another.
pub fn text_boxes(picture: &Picture) -> Result<(Rect, Vec<TextBox>), PlotError> {
    let page = drawn(picture)?;
    Ok((page.page(), page.boxes().to_vec()))
}

/// What is wrong with the layout of a picture, in words: texts that leave the page, texts that cover each other, insets and
/// legends that cover curves. Every figure that is published should have none.
pub fn flaws(picture: &Picture) -> Result<Vec<String>, PlotError> {
    let document = drawn(picture)?;
    let (page, boxes) = (document.page(), document.boxes());
    let mut flaws = document.notes().to_vec();
    for (i, a) in boxes.iter().enumerate() {
        if !page.holds(&a.rect, 0.01) {
            flaws.push(format!("{:?} {:?} leaves the page", a.kind, a.text));
        }
        for b in boxes[i + 1..].iter().filter(|b| a.rect.overlaps(&b.rect, 0.3)) {
            flaws.push(format!("{:?} {:?} covers {:?} {:?}", a.kind, a.text, b.kind, b.text));
        }
    }
    Ok(flaws)
}

fn drawn(picture: &Picture) -> Result<Document, PlotError> {
    if !(picture.height_mm.is_finite() && picture.height_mm > 0.0 && picture.height_mm < 2000.0) {
        return Err(PlotError::BadHeight { height_mm: picture.height_mm });
    }
    let document = Document::new(picture.width.millimetres(), picture.height_mm);
    let page = document.page();
    let mut strip = Vec::new();
    let mut spans = Vec::with_capacity(picture.panels.len());
    for (index, panel) in picture.panels.iter().enumerate() {
        pieces::check(&panel.marks, index, panel.sphere.is_some())?;
        for inset in &panel.insets {
            pieces::check(inset.marks.as_deref().unwrap_or_default(), index, panel.sphere.is_some())?;
        }
        spans.push(pieces::spans(panel, index)?);
        if panel.legend == Legend::Strip {
            legend::collect(&mut strip, &panel.marks);
        }
    }
    let strip_height = legend::strip_height(&strip, page.width());
    let cells = layout::cells(picture, &page, strip_height)?;
    let frames = layout::frames(picture, &cells, &spans)?;
    let paper = Rc::new(RefCell::new(Paper { document }));
    for (index, panel) in picture.panels.iter().enumerate() {
        paper.borrow_mut().document.set_panel(Some(index));
        draw_panel(&paper, picture, index, panel, &frames[index], &cells[index])?;
    }
    paper.borrow_mut().document.set_panel(None);
    legend::draw_strip(&mut paper.borrow_mut(), &strip, page.height() - strip_height, page.width());
    // Nothing else holds the paper any more: plotters' drawing areas are gone.
    Rc::try_unwrap(paper)
        .map(|paper| paper.into_inner().document)
        .map_err(|_| PlotError::Drawing("the paper is still in use".to_string()))
}

/// `a`, `b`, …, `z`, then numbers: begins the ids of a panel's groups.
fn panel_id(index: usize) -> String {
    char::from_digit(index as u32 + 10, 36).map_or_else(|| format!("p{index}"), String::from)
}

fn draw_panel(
    paper: &SharedPaper,
    picture: &Picture,
    index: usize,
    panel: &Panel,
    frame: &Frame,
    cell: &Rect,
) -> Result<(), PlotError> {
    let id = panel_id(index);
    let content = pieces::pieces(&panel.marks, index, &frame.x, &frame.y, panel.sphere.as_ref())?;
    paper.borrow_mut().document.open(&[("id", &format!("panel-{id}"))]);
    if panel.sphere.is_some() {
        draw_disc(&mut paper.borrow_mut().document, frame, &id, true);
    }
    draw_content(paper, frame, &content, &id)?;
    if panel.sphere.is_some() {
        draw_disc(&mut paper.borrow_mut().document, frame, &id, false);
    } else {
        draw_axes(&mut paper.borrow_mut().document, frame, &panel.x, &panel.y, &format!("{id}-axes"), false);
    }
    draw::draw(paper, frame, &content.shapes, &id, true)?;

    // A sphere has no frame: its labels may stand anywhere in its cell.
    let bounds = if panel.sphere.is_some() {
        Rect { top: frame.rect.top.min(cell.top + 14.0), ..*cell }.grown(-1.0)
    } else {
        frame.rect.grown(-1.2)
    };
    let mut scene = draw::scene(frame, &content.shapes, bounds);
    if panel.sphere.is_some() {
        let outline: Vec<_> =
            (0..=90).map(|i| libm::sincos(PI * f64::from(i) / 45.0)).map(|p| frame.on_page(p)).collect();
        scene.segments.extend(outline.windows(2).map(|s| (s[0], s[1])));
    }
    for (number, inset) in panel.insets.iter().enumerate() {
        draw_inset(paper, panel, index, frame, inset, &format!("{id}-inset{}", number + 1), &mut scene)?;
    }
    let mut entries = Vec::new();
    legend::collect(&mut entries, &panel.marks);
    let corner = match panel.legend {
        Legend::Strip | Legend::None => None,
        _ if entries.is_empty() => None,
        Legend::Corner(corner) => Some(corner_rect(frame, legend::box_size(&entries), corner)),
        Legend::FreeCorner => Some(free_corner(frame, legend::box_size(&entries), &scene)),
    };
    if let Some(rect) = corner {
        note_cover(&mut paper.borrow_mut().document, &scene, &rect, index, "legend");
        legend::draw_box(&mut paper.borrow_mut(), &entries, &rect, &format!("{id}-legend"));
        scene.taken.push(rect);
    }
    let page = &mut paper.borrow_mut().document;
    page.open(&[("id", &format!("{id}-labels")), ("data-role", "labels")]);
    draw_wishes(page, frame, &content.wishes, &mut scene);
    page.close();
    if let Some(key) = &panel.tone_key {
        legend::draw_key(page, key, &frame.rect, &format!("{id}-tone-key"));
    }
    draw_title(page, picture, index, panel, frame, cell);
    page.close();
    Ok(())
}

/// Letter and title over the frame.
fn draw_title(page: &mut Document, picture: &Picture, index: usize, panel: &Panel, frame: &Frame, cell: &Rect) {
    let letter = layout::letter(panel, index, picture.panels.len());
    let style = |anchor| TextStyle {
        size: LABEL_SIZE,
        colour: Colour::BLACK,
        anchor,
        halo: false,
        upright: false,
        kind: TextKind::PanelTitle,
    };
    let words = match (letter, &panel.title) {
        (None, None) => return,
        (Some(letter), None) => Label::plain(&format!("({letter})")).bold(),
        (None, Some(title)) => title.clone(),
        (Some(letter), Some(title)) => {
            Label::plain(&format!("({letter})")).bold().then(&Label::plain("\u{a0} ")).then(title)
        }
    };
    let sphere = panel.sphere.is_some();
    let (left, top) =
        if sphere { (cell.left + 2.0, cell.top + LABEL_SIZE + 1.5) } else { (frame.rect.left, frame.rect.top - 4.5) };
    page.text(&words, (left, top), style(Anchor::Start));
}

/// Lines and fills, clipped by the frame.
fn draw_content(paper: &SharedPaper, frame: &Frame, content: &Pieces, id: &str) -> Result<(), PlotError> {
    let clip = format!("{id}-clip");
    {
        let page = &mut paper.borrow_mut().document;
        let (upper_left, lower_right) = frame.corners();
        page.clip(&clip, upper_left, lower_right);
        page.open(&[("clip-path", &format!("url(#{clip})"))]);
    }
    draw::draw(paper, frame, &content.shapes, id, false)?;
    paper.borrow_mut().document.close();
    Ok(())
}

/// Remembers when something is drawn over curves or points.
fn note_cover(page: &mut Document, scene: &Scene, rect: &Rect, panel: usize, what: &str) {
    let free = Scene { bounds: *rect, taken: Vec::new(), ..scene.clone() };
    let cost = free.cost(&rect.grown(-1.0));
    if cost > 0.0 {
        page.note(format!("the {what} of panel {panel} covers curves or points"));
    }
}

/// The disc under a sphere's curves, or its outline over them.
fn draw_disc(page: &mut Document, frame: &Frame, id: &str, filled: bool) {
    let (centre, edge) = (frame.on_page((0.0, 0.0)), frame.on_page((1.0, 0.0)));
    let (at, radius) = ((hundredths(centre.0), hundredths(centre.1)), hundredths(edge.0 - centre.0));
    let name = format!("{id}-{}", if filled { "sphere" } else { "outline" });
    page.open(&[("id", &name), ("data-role", "sphere")]);
    let colour = if filled { Colour(250, 250, 250) } else { Colour(60, 60, 60) };
    page.circle(at, radius, filled, colour, if filled { 0 } else { hundredths(AXIS_WIDTH) });
    page.close();
}

fn corner_rect(frame: &Frame, (width, height): (f64, f64), corner: Corner) -> Rect {
    const OFF: f64 = 3.0;
    let rect = &frame.rect;
    let left = match corner {
        Corner::UpperLeft | Corner::LowerLeft => rect.left + OFF,
        Corner::UpperRight | Corner::LowerRight => rect.right - OFF - width,
    };
    let top = match corner {
        Corner::UpperLeft | Corner::UpperRight => rect.top + OFF,
        Corner::LowerLeft | Corner::LowerRight => rect.bottom - OFF - height,
    };
    Rect { left, right: left + width, top, bottom: top + height }
}

fn free_corner(frame: &Frame, size: (f64, f64), scene: &Scene) -> Rect {
    let corners = [Corner::UpperRight, Corner::UpperLeft, Corner::LowerRight, Corner::LowerLeft];
    let mut best = (f64::INFINITY, corner_rect(frame, size, corners[0]));
    for corner in corners {
        let rect = corner_rect(frame, size, corner);
        let cost = scene.cost(&rect);
        if cost < best.0 {
            best = (cost, rect);
        }
    }
    best.1
}

fn draw_inset(
    paper: &SharedPaper,
    panel: &Panel,
    index: usize,
    frame: &Frame,
    inset: &Inset,
    id: &str,
    scene: &mut Scene,
) -> Result<(), PlotError> {
    let spans = (Span::new(&inset.x, &[], index, 'x')?, Span::new(&inset.y, &[], index, 'y')?);
    let size = (inset.size.0 * frame.rect.width(), inset.size.1 * frame.rect.height());
    // The part of the panel that is magnified, at least 3 pt wide, cut at the panel's frame.
    let (a, b) = (frame.on_page((spans.0.low, spans.1.low)), frame.on_page((spans.0.high, spans.1.high)));
    let around = |p: f64, q: f64, low: f64, high: f64| {
        let (from, to) = (p.min(q), p.max(q));
        let spare = ((3.0 - (to - from)) / 2.0).max(0.0);
        ((from - spare).clamp(low, high), (to + spare).clamp(low, high))
    };
    let (left, right) = around(a.0, b.0, frame.rect.left, frame.rect.right);
    let (top, bottom) = around(a.1, b.1, frame.rect.top, frame.rect.bottom);
    let source = Rect { left, right, top, bottom };
    if inset.source {
        scene.taken.push(source);
    }
    let outer = match inset.place {
        Place::Corner(corner) => corner_rect(frame, size, corner),
        Place::FreeCorner => free_corner(frame, size, scene),
        Place::At(x, y) => {
            let left = frame.rect.left + x * frame.rect.width();
            let bottom = frame.rect.bottom - y * frame.rect.height();
            Rect { left, right: left + size.0, top: bottom - size.1, bottom }
        }
    };
    // Projected coordinates of a sphere mean nothing to a reader.
    let axis =
        |axis: &Axis| if panel.sphere.is_some() { Axis { ticks: Ticks::None, ..axis.clone() } } else { axis.clone() };
    let (x, y) = (axis(&inset.x), axis(&inset.y));
    // Axes at the inset's own scale; the number of ticks settles in two rounds.
    let mut inner = Frame { rect: outer.grown(-8.0), x: spans.0, y: spans.1 };
    for _ in 0..3 {
        if !(inner.rect.width() >= 10.0 && inner.rect.height() >= 10.0) {
            return Err(PlotError::NoRoom { panel: index, width: inner.rect.width(), height: inner.rect.height() });
        }
        let m = axis_margins(&inner, &x, &y, true);
        inner.rect = Rect {
            left: outer.left + m.left,
            right: outer.right - m.right.max(3.0),
            top: outer.top + m.top.max(3.0),
            bottom: outer.bottom - m.bottom,
        };
    }
    note_cover(&mut paper.borrow_mut().document, scene, &outer, index, "inset");
    let marks = inset.marks.as_deref().unwrap_or(&panel.marks);
    let content = pieces::pieces(marks, index, &inner.x, &inner.y, panel.sphere.as_ref())?;
    {
        let page = &mut paper.borrow_mut().document;
        page.open(&[("id", id), ("data-role", "inset")]);
        let whole = |r: &Rect| ((hundredths(r.left), hundredths(r.top)), (hundredths(r.right), hundredths(r.bottom)));
        let (p, q) = whole(&outer);
        page.rect(p, q, true, Colour::WHITE, 0);
        if inset.source {
            let grey = Colour(90, 90, 90);
            page.open_lines(&[("data-role", "inset-source")], grey, 0.4, &[]);
            let (p, q) = whole(&source);
            page.rect(p, q, false, grey, 40);
            page.close();
        }
        // Curves of the panel must not shine through the inset's own frame.
        let (p, q) = whole(&inner.rect);
        page.rect(p, q, true, Colour::WHITE, 0);
    }
    draw_content(paper, &inner, &content, id)?;
    draw_axes(&mut paper.borrow_mut().document, &inner, &x, &y, &format!("{id}-axes"), true);
    draw::draw(paper, &inner, &content.shapes, id, true)?;
    let page = &mut paper.borrow_mut().document;
    if let Some((from, to)) = inset.source.then(|| leader(&source, &inner.rect, page.boxes())).flatten() {
        let grey = Colour(90, 90, 90);
        page.path([from, to].map(|(x, y)| (hundredths(x), hundredths(y))), false, false, grey, 40);
        scene.segments.push((from, to));
    }
    if inset.marks.is_some() {
        let mut inside = draw::scene(&inner, &content.shapes, inner.rect.grown(-1.0));
        draw_wishes(page, &inner, &content.wishes, &mut inside);
    }
    page.close();
    scene.taken.push(outer);
    Ok(())
}

/// The line from a corner of the source to a corner or a quarter of an edge of the inset's frame that is short and crosses neither of them nor a
/// text; none when they overlap.
fn leader(source: &Rect, inset: &Rect, texts: &[TextBox]) -> Option<((f64, f64), (f64, f64))> {
    if source.overlaps(inset, 0.0) {
        return None;
    }
    let corners = |r: &Rect| [(r.left, r.top), (r.right, r.top), (r.left, r.bottom), (r.right, r.bottom)];
    let quarters = |r: &Rect| {
        let part = |i: u32| (r.left + r.width() * f64::from(i) / 4.0, r.top + r.height() * f64::from(i) / 4.0);
        (0..=4).map(part).flat_map(|(x, y)| [(x, r.top), (x, r.bottom), (r.left, y), (r.right, y)]).collect::<Vec<_>>()
    };
    let mut best = None;
    let mut least = f64::INFINITY;
    for from in corners(source) {
        for to in quarters(inset) {
            let crosses = |rect: &Rect| place::length_inside(from, to, rect) > 0.0;
            let distance = ((to.0 - from.0) * (to.0 - from.0) + (to.1 - from.1) * (to.1 - from.1)).sqrt();
            let texts = texts.iter().filter(|text| crosses(&text.rect.grown(0.7))).count() as f64;
            let through =
                f64::from(u8::from(crosses(&source.grown(-0.1)))) + f64::from(u8::from(crosses(&inset.grown(-0.1))));
            let cost = distance + 1e4 * texts + 1e6 * through;
            if cost < least {
                (least, best) = (cost, Some((from, to)));
            }
        }
    }
    best
}

/// The colour of words that belong to a mark: its own, darkened until it reads on white.
fn words_colour(wish: &Wish) -> Colour {
    let colour = match (wish.tone, wish.role) {
        (Some(tone), _) => batlow(tone),
        (None, Some(role)) => role.look().colour,
        (None, None) => return Colour::BLACK,
    };
    let darker = |v: u8| (u32::from(v) * 78 / 100) as u8;
    Colour(darker(colour.0), darker(colour.1), darker(colour.2))
}

/// Labels, those with a given place first.
fn draw_wishes(page: &mut Document, frame: &Frame, wishes: &[Wish], scene: &mut Scene) {
    let freedom = |wish: &&Wish| match (&wish.target, wish.label.side, wish.label.at) {
        (Target::Point(..), Some(_), _) => 0,
        (_, Some(_), At::Start | At::End | At::Fraction(_)) => 1,
        (Target::Point(..), None, _) => 2,
        (_, None, At::Start | At::End | At::Fraction(_)) => 3,
        (_, _, At::Auto) => 4,
    };
    let mut order: Vec<&Wish> = wishes.iter().collect();
    order.sort_by_key(freedom);
    for wish in order {
        let Some(spot) = spot(frame, wish, scene, &page.page()) else { continue };
        let style = TextStyle {
            size: TEXT_SIZE,
            colour: words_colour(wish),
            anchor: spot.anchor,
            halo: true,
            upright: false,
            kind: TextKind::Direct,
        };
        page.text(&wish.label.text, spot.at, style);
        scene.taken.push(spot.rect);
    }
}

/// The place of a label; `None` when what it belongs to is not seen.
fn spot(frame: &Frame, wish: &Wish, scene: &Scene, page: &Rect) -> Option<Spot> {
    let text = &wish.label.text;
    let on = |point, side, gap| place::beside(text, TEXT_SIZE, point, side, gap);
    let sides: Vec<Side> = wish.label.side.map_or_else(|| SIDES.to_vec(), |side| vec![side]);
    let best = match &wish.target {
        Target::Point(at, radius) => {
            let point = frame.on_page(*at);
            let near = frame.rect.grown(25.0);
            if !near.holds(&Rect { left: point.0, right: point.0, top: point.1, bottom: point.1 }, 0.0) {
                return None;
            }
            let gap = if *radius > 0.0 { radius + 1.6 } else { 1.0 };
            if let [side] = sides[..] {
                // Words that the experiment put somewhere stay there, as long as they stay on the page.
                return Some(place::moved_inside(on(point, side, gap), &page.grown(-0.5)));
            }
            scene.best(sides.iter().enumerate().map(|(i, &side)| (on(point, side, gap), i as f64)))
        }
        Target::Curve(points) => {
            let parts = draw::visible(frame, points);
            let seen: Vec<(f64, f64)> = parts.iter().flatten().copied().collect();
            let (first, last) = (*seen.first()?, *seen.last()?);
            let points = match wish.label.at {
                At::Start => vec![first],
                At::End => vec![last],
                At::Fraction(part) => vec![nearest(frame, points, &seen, part)],
                At::Auto => place::along(&parts, 33),
            };
            let spots = points.iter().flat_map(|&point| sides.iter().map(move |&side| (point, side)));
            scene.best(spots.enumerate().map(|(i, (point, side))| (on(point, side, GAP), 0.01 * i as f64)))
        }
        Target::Rule(along, at) => {
            let rect = &frame.rect;
            let ends = match along {
                Along::X => {
                    let y = frame.on_page((frame.x.low, *at)).1;
                    [(rect.left + 1.0, y), (rect.right - 1.0, y)]
                }
                Along::Y => {
                    let x = frame.on_page((*at, frame.y.low)).0;
                    [(x, rect.bottom - 7.0), (x, rect.top + 7.0)]
                }
            };
            let part = |t: f64| (ends[0].0 + t * (ends[1].0 - ends[0].0), ends[0].1 + t * (ends[1].1 - ends[0].1));
            let places: Vec<f64> = match wish.label.at {
                At::Start => vec![0.0],
                At::End => vec![1.0],
                At::Fraction(t) => vec![t],
                At::Auto => (0..=24).map(|i| 1.0 - f64::from(i) / 24.0).collect(),
            };
            let sides: &[Side] = match (wish.label.side, along) {
                (Some(_), _) => &sides,
                (None, Along::X) => {
                    &[Side::AboveLeft, Side::BelowLeft, Side::AboveRight, Side::BelowRight, Side::Above]
                }
                (None, Along::Y) => &[Side::Right, Side::Left],
            };
            let spots = places.iter().flat_map(|&t| sides.iter().map(move |&side| (part(t), side)));
            scene.best(spots.enumerate().map(|(i, (point, side))| (on(point, side, GAP - 0.6), 0.2 * i as f64)))
        }
    };
    best.map(|spot| place::moved_inside(spot, &scene.bounds))
}

/// The seen point nearest to the one at a fraction of a curve's list of points.
fn nearest(frame: &Frame, points: &[(f64, f64)], seen: &[(f64, f64)], part: f64) -> (f64, f64) {
    let finite: Vec<_> = points.iter().filter(|p| !p.0.is_nan() && !p.1.is_nan()).collect();
    let index = (part * finite.len().saturating_sub(1) as f64 + 0.5) as usize;
    let wanted = finite.get(index).map_or(seen[0], |p| {
        // Far outside the frame the page's integers would end: any point of that side will do.
        let room = frame.window(1000.0);
        frame.on_page((p.0.clamp(room.left, room.right), p.1.clamp(room.top, room.bottom)))
    });
    let distance = |p: &(f64, f64)| (p.0 - wanted.0) * (p.0 - wanted.0) + (p.1 - wanted.1) * (p.1 - wanted.1);
    seen.iter().copied().min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(wanted)
}
