//! Section "What if" of a page: fields for other tolerances and means, and a card of results for each characteristic.

use crate::document::number::{plain, significant};
use crate::document::svg::escaped;
use crate::html::part::Part;
use crate::html::what_if::{Tried, Wanted, WhatIf};

/// Figures of a card, by the names under which the page's script fills them in.
const FIGURES: [&str; 8] = ["mean", "sigma", "skewness", "kurtosis", "yield", "ppm below", "ppm above", "Cpk"];

/// Writes the section if something can be changed and results can follow it.
pub(super) fn section(of: &WhatIf) -> String {
    let characteristics = || of.characteristics().iter().enumerate();
    let cards: String = characteristics().map(card).collect();
    let line = |(index, one): (usize, &Wanted)| {
        format!("<p data-line=\"{index}\"><strong>{}</strong> <span></span></p>\n", escaped(&one.name))
    };
    let strip: String = characteristics().filter(|(_, one)| one.why.is_none()).map(line).collect();
    let cost = of.paid().map(|paid| {
        let paid = paid.map_or("no process holds these tolerances".to_owned(), |paid| significant(paid, 6));
        let paid = escaped(&paid);
        format!(
            "<p class=\"total\">Cost of the tolerances: analysed <strong>{paid}</strong>, as set <strong id=\"cost\"></strong></p>\n"
        )
    });
    let cost = cost.unwrap_or_default();
    let choice =
        |(index, one): (usize, &Wanted)| format!("<option value=\"{index}\">{}</option>\n", escaped(&one.name));
    let choices: String = characteristics().filter(|(_, one)| one.why.is_none()).map(choice).collect();
    let rows: String = of.dimensions().iter().enumerate().map(row).collect();
    let [copy, copied] = match of.written() {
        true => [COPY, COPIED],
        false => [""; 2],
    };
    format!(
        r#"<section aria-labelledby="what-if-title" id="what-if" hidden>
<h2 id="what-if-title">What if</h2>
<p>Try other tolerances and means. Results update from the fitted surface; run sensitol again to confirm. <span class="print-only">As set when printed.</span></p>
<div class="strip" tabindex="0" role="region" aria-label="Results as set" aria-live="polite">
{strip}</div>
{cost}<p class="tools"><label>Shares of the variance of <select id="share-of">
{choices}</select></label>
<button type="button" id="reset">Back to the study</button>
{copy}</p>
<div class="wide" tabindex="0"><table class="tries">
<thead><tr><th scope="col">dimension</th><th scope="col" class="n">nominal</th><th scope="col">half tolerance</th><th scope="col">mean moved by</th><th scope="col">share of the variance</th></tr></thead>
<tbody>
{rows}</tbody>
</table></div>
<p class="note">Bars: linear part, curvature, and half of each interaction of the dimension. All other sections show the study as analysed.</p>
<div class="cards">
{cards}</div>
{copied}</section>
"#
    )
}

const COPY: &str =
    "<button type=\"button\" id=\"copy\">Copy as TOML</button> <span id=\"copied\" role=\"status\"></span>\n";
const COPIED: &str = "<details><summary>The changed section [dimensions]</summary><textarea id=\"toml\" readonly rows=\"8\" spellcheck=\"false\" aria-label=\"The changed section dimensions as TOML\"></textarea></details>\n";

/// Writes the section with the reason why nothing can be changed.
pub(super) fn impossible(why: &str) -> String {
    let why = escaped(why);
    let said = format!("<p>Nothing can be changed in this page: {why}. Change the study and analyze it again.</p>\n");
    Part::new("what-if-title", "What if", said).on_screen()
}

/// Writes the card of a characteristic, as analysed and as set. The page's script fills in the figures.
fn card((index, one): (usize, &Wanted)) -> String {
    let unit = one.unit.as_deref().filter(|unit| !unit.is_empty());
    let unit = unit.map(|unit| format!(" <small>[{}]</small>", escaped(unit))).unwrap_or_default();
    let head = format!(
        "<article class=\"card\" data-kc=\"{index}\">\n<h3>{}{unit} <span class=\"badge\" data-figure=\"verdict\"></span></h3>\n",
        escaped(&one.name)
    );
    if let Some(why) = &one.why {
        return format!("{head}<p>Not available here: {}.</p>\n</article>\n", escaped(why));
    }
    let figure = |name: &str| {
        format!(
            "<tr><th scope=\"row\">{name}</th><td class=\"n\" data-before=\"{name}\"></td><td class=\"n\" data-figure=\"{name}\"></td></tr>\n"
        )
    };
    let figures: String = FIGURES.into_iter().map(figure).collect();
    let screened = match one.screened {
        0 => String::new(),
        1 => "<p class=\"note\">One interaction of this surface is estimated, without being examined.</p>\n".to_owned(),
        count => format!(
            "<p class=\"note\">{count} interactions of this surface are estimated, without being examined.</p>\n"
        ),
    };
    format!(
        r#"{head}<svg class="small" viewBox="0 0 640 200" preserveAspectRatio="none" role="img" aria-label="Density as analysed, dashed, and as set; thin: the Pearson fit"><path class="fit"/><path class="before"/><path class="now"/><path class="limit" data-limit="lower"/><path class="limit" data-limit="upper"/></svg>
<table class="live"><thead><tr><td></td><th scope="col" class="n">analysed</th><th scope="col" class="n">as set</th></tr></thead><tbody>
{figures}</tbody></table>
<p class="note" data-by></p>
{screened}</article>
"#
    )
}

/// Writes the fields of a dimension.
fn row((index, one): (usize, &Tried)) -> String {
    let (name, nominal) = (escaped(&one.name), escaped(&plain(one.nominal)));
    let unit = escaped(one.unit.as_deref().unwrap_or_default());
    let fields = match one.fixed {
        Some(why) => format!("<td colspan=\"2\" class=\"note\">stays as it is: {}</td>\n", escaped(why)),
        None => {
            let (half, sigmas) =
                (one.half, if one.band.is_some() { "" } else { "<span class=\"note\">3 sigma</span>" });
            format!(
                r#"<td data-label="half tolerance"><span class="pair"><input type="range" data-set="factor" min="1" max="300" step="1" value="100" aria-label="Half tolerance of {name}, percent of the study's"><input type="number" data-number="factor" min="0" step="any" value="{half}" aria-label="Half tolerance of {name}">{sigmas}</span></td>
<td data-label="mean moved by"><span class="pair"><input type="range" data-set="shift" min="-100" max="100" step="1" value="0" aria-label="Mean of {name} moved, percent of half its tolerance"><input type="number" data-number="shift" step="any" value="0" aria-label="Mean of {name} moved by"></span></td>
"#
            )
        }
    };
    format!(
        r#"<tr data-dimension="{index}"><th scope="row">{name}</th><td class="n" data-label="nominal">{nominal} {unit}</td>
{fields}<td data-label="share"><svg class="bar" viewBox="0 0 100 10" preserveAspectRatio="none" aria-hidden="true"><rect class="linear" height="10"/><rect class="curvature" height="10"/><rect class="interaction" height="10"/></svg> <span data-share></span></td></tr>
"#
    )
}
