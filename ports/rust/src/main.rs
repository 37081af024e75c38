//! A port of uncross to Rust, written from docs/port/contract.md alone.
//! `port PACK OUT` reads a pack in text and writes its outputs; `port --trace START OUT` writes a trace.

mod collision;
mod contact;
mod crossing;
mod elementary;
mod events;
mod flight;
mod forces;
mod operators;
mod pack;
mod random;
mod scene;
mod sweep;
mod trace;
mod vector;
mod wide;

use std::{env, fs, process};

fn run(arguments: &[String]) -> Result<(), String> {
    let (tracing, paths) = match arguments {
        [flag, rest @ ..] if flag == "--trace" => (true, rest),
        all => (false, all),
    };
    if paths.len() != 2 {
        return Err("usage: port [--trace] INPUT OUTPUT".to_string());
    }
    let text = fs::read_to_string(&paths[0]).map_err(|error| format!("{}: {}", paths[0], error))?;
    let pack = pack::Pack::parse(&text)?;
    let output = if tracing { trace::trace(&pack)? } else { operators::all(&pack)? };
    fs::write(&paths[1], output).map_err(|error| format!("{}: {}", paths[1], error))
}

fn main() {
    let arguments: Vec<String> = env::args().skip(1).collect();
    if let Err(message) = run(&arguments) {
        eprintln!("port: {}", message);
        process::exit(2);
    }
}
