//! Every operator of a pack, each from the pack's own input: docs/port/operators.md, "The operators".

use crate::collision::{self as mpc, Cells, Members, Sums};
use crate::contact::{impulse, Ends};
use crate::crossing::{cross_bonds, exchange, Four, Test};
use crate::events;
use crate::flight::Flight;
use crate::forces;
use crate::pack::{Group, Pack, Writer};
use crate::random::{normal, uniform, Source, VERTEX_ORDER};
use crate::scene::Scene;
use crate::sweep::{sweep, Event};
use crate::vector::*;

pub fn all(pack: &Pack) -> Result<String, String> {
    let scene = Scene::read(pack)?;
    let mut text = String::new();
    for (&(operator, step), group) in &pack.groups {
        let mut out = Writer { text: &mut text, operator, step };
        one(&scene, operator, step, group, &mut out)?;
    }
    Ok(text)
}

fn one(scene: &Scene, operator: &str, step: u64, group: &Group, out: &mut Writer) -> Result<(), String> {
    match operator {
        "model" => {}
        "random" => random(scene, group, out),
        "permutation" => permutation(scene, group, out),
        "order" => order(scene, step, out),
        "crossing" => crossing(group, out),
        "exchange" => exchanges(group, out),
        "long_sweep" | "sweep" => sweeps(scene, group, out),
        "contact_search" => contact_searches(group, out),
        "impulse" => impulses(group, out),
        "long_event_drift" | "event_drift" => event_drifts(scene, group, out),
        "bond_force" | "bend_force" | "force" => force(scene, operator, group, out),
        "kick" => kick(scene, group, out),
        "stream" => stream(scene, group, out),
        "shift" => out.triple(0, "shift", mpc::shift(scene, step)),
        "bin" => bin(scene, group, out),
        "sum" => sum(scene, group, out),
        "draw" => draw(scene, step, scene.particles, out),
        "solve" | "mean" => solve(scene, operator, step, group, out),
        "rescale" | "maxwell_boltzmann" => thermostat(scene, operator, step, group, out),
        "rotate" => rotate(scene, group, out),
        "give" => give(group, out),
        "swap" => swap(scene, step, group, out),
        other => return Err(format!("unknown operator {}", other)),
    }
    Ok(())
}

fn random(scene: &Scene, group: &Group, out: &mut Writer) {
    let column = |name: &str| group.integers("address", name);
    let (purpose, draw, step, entity) = (column("purpose"), column("draw"), column("step"), column("entity"));
    for row in 0..purpose.len() {
        let source = Source { key: scene.key, purpose: purpose[row] as u32, step: step[row] as u64 };
        let words = source.words(draw[row] as u32, entity[row] as u32);
        for (k, word) in words.iter().enumerate() {
            out.value(row, "word", k, *word);
        }
        out.value(row, "uniform", 0, uniform(words, 0));
        out.value(row, "uniform", 1, uniform(words, 1));
        let (first, second) = normal(words);
        out.value(row, "normal", "first", first);
        out.value(row, "normal", "second", second);
        out.triple(row, "axis", source.axis(entity[row] as u32));
    }
}

fn permutation(scene: &Scene, group: &Group, out: &mut Writer) {
    let value = |name: &str| group.integer("address", name);
    let source = Source { key: scene.key, purpose: value("purpose") as u32, step: value("step") as u64 };
    let order = source.permutation(value("draw") as u32, value("size") as usize);
    out.column("order", "entry", &order);
}

fn order(scene: &Scene, step: u64, out: &mut Writer) {
    let order = scene.source(VERTEX_ORDER, step).permutation(0, scene.vertices());
    out.column("order", "vertex", &order);
}

fn crossing(group: &Group, out: &mut Writer) {
    let points = |table: &str| -> Vec<Point> { group.points(table) };
    let (from, to, pivot, a, b) = (points("from"), points("to"), points("pivot"), points("a"), points("b"));
    let flip = group.integers("flip", "flip");
    for row in 0..from.len() {
        let (from, to, pivot, a, b, flip) = (from[row], to[row], pivot[row], a[row], b[row], flip[row] != 0);
        let found = cross_bonds(&Test { from, to, pivot, a, b, flip });
        out.value(row, "crosses", "crosses", i64::from(found.is_some()));
        write_hit(out, row, &found.unwrap_or_default());
    }
}

fn write_hit(out: &mut Writer, row: usize, hit: &crate::crossing::Hit) {
    out.value(row, "hit", "time", hit.time);
    out.value(row, "hit", "s", hit.s);
    out.value(row, "hit", "s_standing", hit.s_standing);
    for (axis, name) in ["normal_x", "normal_y", "normal_z"].iter().enumerate() {
        out.value(row, "hit", name, hit.normal[axis]);
    }
}

const FOUR: [&str; 4] = ["moving", "pivot", "a", "b"];

fn exchanges(group: &Group, out: &mut Writer) {
    let velocity = FOUR.map(|name| group.vectors(name));
    let mass = FOUR.map(|name| group.reals("mass", name));
    let (s, s_standing) = (group.reals("contact", "s"), group.reals("contact", "s_standing"));
    let normal = group.vectors("normal");
    for row in 0..s.len() {
        let vertices = [0, 1, 2, 3];
        let mut four = Four { velocity: vertices.map(|k| velocity[k][row]), mass: vertices.map(|k| mass[k][row]) };
        let momentum = exchange(&mut four, s[row], s_standing[row], normal[row]);
        out.value(row, "momentum", "momentum", momentum);
        for k in vertices {
            out.triple(row, FOUR[k], four.velocity[k]);
        }
    }
}

fn sweeps(scene: &Scene, group: &Group, out: &mut Writer) {
    let order: Vec<usize> = group.integers("order", "vertex").iter().map(|&j| j as usize).collect();
    let (mut r, mut v) = (group.points("position"), group.vectors("velocity"));
    let events = sweep(scene, group.real("time", "dt"), &order, &mut r, &mut v);
    for (row, event) in events.iter().enumerate() {
        write_event(out, row, event);
    }
    out.triples("position", &r);
    out.triples("velocity", &v);
}

fn write_event(out: &mut Writer, row: usize, event: &Event) {
    out.value(row, "event", "vertex", event.vertex);
    out.value(row, "event", "moving", event.moving);
    out.value(row, "event", "standing", event.standing);
    for (axis, name) in ["image_x", "image_y", "image_z"].iter().enumerate() {
        out.value(row, "event", name, event.image[axis]);
    }
    out.value(row, "event", "executed", i64::from(event.executed));
    write_hit(out, row, &event.hit);
    out.value(row, "hit", "momentum", event.momentum);
}

fn contact_searches(group: &Group, out: &mut Writer) {
    let place = ["p", "q", "w"].map(|table| group.points(table));
    let rate = ["p_rate", "q_rate", "w_rate"].map(|table| group.points(table));
    for (row, &from) in group.integers("from", "tick").iter().enumerate() {
        let of_row = |points: &[Vec<Point>; 3]| [0, 1, 2].map(|k| points[k][row]);
        out.value(row, "tick", "tick", Flight { place: of_row(&place), rate: of_row(&rate) }.search(from));
    }
}

const ENDS: [&str; 4] = ["p0", "p1", "q0", "q1"];

fn impulses(group: &Group, out: &mut Writer) {
    let velocity = ENDS.map(|name| group.vectors(name));
    let force = ENDS.map(|name| group.vectors(&format!("force_{}", name)));
    let mass = ENDS.map(|name| group.reals("mass", name));
    let (s, t) = (group.reals("contact", "s"), group.reals("contact", "t"));
    let (normal, tau) = (group.vectors("normal"), group.reals("tau", "tau"));
    for row in 0..s.len() {
        let of_row = |vectors: &[Vec<Vector>; 4]| [0, 1, 2, 3].map(|k| vectors[k][row]);
        let mass = [0, 1, 2, 3].map(|k| mass[k][row]);
        let mut ends = Ends { velocity: of_row(&velocity), force: of_row(&force), mass };
        let (answer, momentum) = impulse(&mut ends, s[row], t[row], normal[row], tau[row]);
        out.value(row, "answer", "answer", answer as i64);
        out.value(row, "momentum", "momentum", momentum);
        for (k, name) in ENDS.iter().enumerate() {
            out.triple(row, name, ends.velocity[k]);
        }
    }
}

fn event_drifts(scene: &Scene, group: &Group, out: &mut Writer) {
    let (mut r, mut v) = (group.points("position"), group.vectors("velocity"));
    let rows = events::drift(scene, group.real("time", "dt"), group.real("time", "start"), &mut r, &mut v);
    for (row, event) in rows.iter().enumerate() {
        out.value(row, "event", "bond", event.bond);
        out.value(row, "event", "other", event.other);
        for (axis, name) in ["image_x", "image_y", "image_z"].iter().enumerate() {
            out.value(row, "event", name, event.image[axis]);
        }
        out.value(row, "event", "tick", event.tick);
        out.value(row, "hit", "s", event.contact.s);
        out.value(row, "hit", "t", event.contact.t);
        for (axis, name) in ["normal_x", "normal_y", "normal_z"].iter().enumerate() {
            out.value(row, "hit", name, event.contact.normal[axis]);
        }
        out.value(row, "hit", "momentum", event.momentum);
    }
    out.triples("position", &r);
    out.triples("velocity", &v);
}

fn force(scene: &Scene, operator: &str, group: &Group, out: &mut Writer) {
    let position = group.points("position");
    let mut force = vec![[0.0; 3]; position.len()];
    match operator {
        "bond_force" => forces::add_bonds(scene, &position, &mut force),
        "bend_force" => forces::add_bends(scene, &position, &mut force),
        _ => force = forces::all(scene, &position),
    }
    out.triples("force", &force);
}

fn kick(scene: &Scene, group: &Group, out: &mut Writer) {
    let mut velocity = group.vectors("velocity");
    forces::kick(scene, group.real("time", "dt"), &mut velocity, &group.vectors("force"));
    out.triples("velocity", &velocity);
}

fn stream(scene: &Scene, group: &Group, out: &mut Writer) {
    let (mut r, mut v) = (group.points("position"), group.vectors("velocity"));
    mpc::stream(scene, group.real("time", "dt"), &mut r, &mut v);
    out.triples("position", &r);
    out.triples("velocity", &v);
}

fn bin(scene: &Scene, group: &Group, out: &mut Writer) {
    let shift = group.points("shift")[0];
    for table in ["solvent", "vertex"] {
        out.column(table, "cell", &mpc::bin(scene, shift, &group.points(table)));
    }
}

fn cells_of(group: &Group, table: &str) -> Vec<usize> {
    group.integers(table, "cell").iter().map(|&cell| cell as usize).collect()
}

/// Calls a function with the members of a group.
fn with_members<T>(group: &Group, call: impl FnOnce(&Members) -> T) -> T {
    let (solvent_cell, vertex_cell) = (cells_of(group, "solvent_cell"), cells_of(group, "vertex_cell"));
    let (solvent, vertex) = (group.vectors("solvent"), group.vectors("vertex"));
    call(&Members { solvent_cell: &solvent_cell, vertex_cell: &vertex_cell, solvent: &solvent, vertex: &vertex })
}

fn sum(scene: &Scene, group: &Group, out: &mut Writer) {
    let sums = with_members(group, |members| mpc::sum(scene, members));
    out.triples("momentum", &sums.momentum);
    out.column("load", "members", &sums.members);
    out.column("load", "mass", &sums.mass);
}

fn sums_of(group: &Group) -> Sums {
    let (members, mass) = (group.integers("load", "members"), group.integers("load", "mass"));
    Sums { momentum: group.points("momentum"), members, mass }
}

fn solve(scene: &Scene, operator: &str, step: u64, group: &Group, out: &mut Writer) {
    let cells = mpc::solve(scene, step, &sums_of(group));
    for (cell, active) in cells.active.iter().enumerate() {
        out.value(cell, "active", "active", i64::from(*active));
    }
    out.triples("center", &cells.center);
    if operator == "solve" {
        out.triples("axis", &cells.axis);
    }
}

fn draw(scene: &Scene, step: u64, particles: usize, out: &mut Writer) {
    let (solvent, vertex) = mpc::draw(scene, step, particles);
    out.triples("solvent", &solvent);
    out.triples("vertex", &vertex);
}

fn give(group: &Group, out: &mut Writer) {
    let active = group.integers("active", "active").iter().map(|&active| active != 0).collect();
    let cells = Cells { active, center: group.vectors("center"), axis: Vec::new() };
    for table in ["solvent", "vertex"] {
        let mut velocity = group.vectors(table);
        let cell_of = cells_of(group, &format!("{}_cell", table));
        mpc::give(&cells, &cell_of, &group.vectors(&format!("{}_drawn", table)), &mut velocity);
        out.triples(table, &velocity);
    }
}

fn thermostat(scene: &Scene, operator: &str, step: u64, group: &Group, out: &mut Writer) {
    let sums = sums_of(group);
    let center = group.vectors("center");
    let relative = with_members(group, |members| mpc::relative(scene, members, &sums, &center));
    let factor = match operator {
        "rescale" => mpc::rescale(&sums, &relative),
        _ => mpc::maxwell_boltzmann(scene, step, &sums, &relative),
    };
    out.column("relative", "energy", &relative);
    out.column("factor", "factor", &factor);
}

fn rotate(scene: &Scene, group: &Group, out: &mut Writer) {
    let active = group.integers("active", "active").iter().map(|&active| active != 0).collect();
    let cells = Cells { active, center: group.vectors("center"), axis: group.vectors("axis") };
    let factor = group.reals("factor", "factor");
    for (table, cell_table) in [("solvent", "solvent_cell"), ("vertex", "vertex_cell")] {
        let mut velocity = group.vectors(table);
        mpc::rotate(scene, &cells, &factor, &cells_of(group, cell_table), &mut velocity);
        out.triples(table, &velocity);
    }
}

fn swap(scene: &Scene, step: u64, group: &Group, out: &mut Writer) {
    let mut velocity = group.vectors("velocity");
    let order = mpc::swap(scene, step, &mut velocity);
    out.column("order", "particle", &order);
    out.triples("velocity", &velocity);
}
