//! The engine for the workbench: studies as text in, results and errors as JSON out.

use js_sys::Function;
use sensitol_report::task::{Task, TaskPlace, models as built_in};
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen::{JsError, JsValue};

/// The function that a page calls once: a panic then has a message, which the page shows.
#[wasm_bindgen(start)]
pub fn start() {
    std::panic::set_hook(Box::new(|panic| wasm_bindgen::throw_str(&format!("the engine failed: {panic}"))));
}

/// The version of the engine.
#[wasm_bindgen]
pub fn version() -> String {
    env!("CARGO_PKG_VERSION").to_owned()
}

/// The built-in models, with inputs and outputs.
#[wasm_bindgen]
pub fn models() -> String {
    built_in()
}

/// A study in keys of JSON, so that a table can show it: `{"study": ..}`, `{"faults": [..]}`. `told` is a
/// task without `asked`.
#[wasm_bindgen]
pub fn study(told: &str) -> Result<String, JsError> {
    Ok(Task::read(told)?.study(&TaskPlace::default()))
}

/// Does a task: `{"text", "format", "name", "files", "configuration", "analysis", "characteristics", "asked", "forms"}`. The answer
/// has every form that is asked for, of `json`, `html`, `text`, `svg`, `tables`; or `faults` of the study, or an `error`.
/// `counted` is told how many points are answered and expected.
#[wasm_bindgen]
pub fn run(told: &str, counted: &Function) -> Result<String, JsError> {
    let progress = |answered: u64, expected: u64| {
        // Who does not listen loses nothing.
        let _ = counted.call2(&JsValue::NULL, &JsValue::from_f64(answered as f64), &JsValue::from_f64(expected as f64));
    };
    Ok(Task::read(told)?.run(&TaskPlace::default(), &progress))
}
