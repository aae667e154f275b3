// Styles and script of a chart's page. The script only shows tooltips, made from what is in the page.
#pragma once
#include <string_view>

namespace tyndall {
// Style of the drawings, on the page and in separate files.
inline constexpr std::string_view chart_svg_style = R"css(
svg.chart { color: #1a1a1a; max-width: 860px; } svg.chart text { font-family: system-ui, Helvetica, Arial, sans-serif; }
.paper, .hollow { fill: #fff; }
.grid { stroke: #ececec; stroke-width: 1; } .grid.strong { stroke: #c6c6c6; }
.break { stroke: #777; stroke-width: 1; stroke-dasharray: 7 3; }
.tick { font-size: 14.5px; fill: #444; } .axis { font-size: 16px; fill: #222; } .legend { font-size: 16px; fill: #222; }
.series { fill: none; stroke-width: 1.8; } .fitted { stroke-dasharray: 5 4; }
.series.quiet, .hollow.quiet { stroke: #777; stroke-width: 1.8; }
.front { fill: none; stroke: #999; stroke-width: 7; stroke-opacity: 0.28; stroke-linejoin: round; }
.whisker { stroke: #777; stroke-width: 1; }
@media (prefers-color-scheme: dark) {
  svg.chart { color: #e8e8e8; } .paper, .hollow { fill: #181818; } .grid { stroke: #2a2a2a; } .grid.strong { stroke: #484848; }
  .tick { fill: #bbb; } .axis, .legend { fill: #ddd; } .front { stroke-opacity: 0.4; }
}
)css";

inline constexpr std::string_view chart_page_style = R"css(
:root { color-scheme: light dark; }
body { font: 15px/1.5 system-ui, sans-serif; color: #1a1a1a; background: #fff; max-width: 1000px; margin: 2em auto;
       padding: 0 1em; }
h1 { font-size: 1.6em; } h2 { font-size: 1.2em; margin-top: 2em; } h3 { font-size: 1em; margin: 1.5em 0 0.3em; }
p.quiet, .quiet { color: #555; }
svg.chart { width: 100%; height: auto; display: block; }
.mark { cursor: pointer; } .mark:focus { outline: none; }
.mark:hover g, .mark:focus g { stroke: currentColor; stroke-width: 2.5; }
table { border-collapse: collapse; font-size: 13px; } th, td { padding: 2px 9px; text-align: right; }
th { text-align: right; border-bottom: 1px solid #888; vertical-align: bottom; } td { border-bottom: 1px solid #e6e6e6; }
th:first-child, td:first-child, td.words, th.words { text-align: left; }
.wide { overflow-x: auto; }
.rung { display: inline-block; width: 228px; margin: 0 9px 12px 0; font-size: 12px; vertical-align: top; }
.rung img { width: 100%; display: block; }
#tip { position: fixed; z-index: 2; width: 330px; padding: 10px; font-size: 13px; background: #fff; color: #111;
       border: 1px solid #555; box-shadow: 0 3px 12px #0004; pointer-events: none; }
#tip img { width: 49%; vertical-align: top; } #tip dl { display: grid; grid-template-columns: auto auto; margin: 4px 0; }
#tip dt { color: #555; } #tip dd { margin: 0; text-align: right; } #tip code { font-size: 11px; }
@media (prefers-color-scheme: dark) {
  body { color: #e8e8e8; background: #181818; } p.quiet, .quiet, #tip dt { color: #aaa; } td { border-bottom-color: #383838; }
  #tip { background: #242424; color: #eee; }
}
@media print { body { max-width: none; margin: 0; font-size: 11px; } #tip { display: none; }
  svg.chart, .rung, tr { break-inside: avoid; } table { font-size: 8px; } th, td { padding: 1px 3px; }
  .rung { width: 150px; } h2 { break-after: avoid; } .wide { overflow: visible; } }
)css";

// A mark's id names the table row with its numbers and the images in the gallery.
inline constexpr std::string_view chart_page_script = R"js(
"use strict";
const tip = document.getElementById("tip");
function show(id, x, y) {
  const row = document.getElementById("row-" + id.replace(".fitted", ""));
  if (!row) return;
  const heads = row.closest("table").querySelectorAll("thead th");
  const title = document.createElement("b");
  title.textContent = id.endsWith(".fitted") ? row.cells[0].textContent + ", gain fitted" : row.cells[0].textContent;
  const list = document.createElement("dl");
  for (let i = 1; i < row.cells.length; ++i) {
    if (row.cells[i].textContent === "-") continue;
    const name = document.createElement("dt"), value = document.createElement("dd");
    name.textContent = heads[i].textContent;
    value.textContent = row.cells[i].textContent;
    list.append(name, value);
  }
  const settings = document.createElement("code");
  settings.textContent = row.dataset.settings;
  tip.replaceChildren(title, list, settings, document.createElement("br"));
  for (const image of document.querySelectorAll('[data-of="' + id.replace(".fitted", "") + '"] img')) {
    const copy = document.createElement("img");
    copy.src = image.src;
    copy.alt = image.alt;
    tip.append(copy, " ");
  }
  tip.hidden = false;
  const box = tip.getBoundingClientRect();
  tip.style.left = Math.max(4, x + 18 + box.width > innerWidth ? x - box.width - 18 : x + 18) + "px";
  tip.style.top = Math.max(4, Math.min(y - 40, innerHeight - box.height - 4)) + "px";
}
function showMark(mark) {
  const box = mark.getBoundingClientRect();
  show(mark.dataset.id, box.right, box.top);
}
for (const mark of document.querySelectorAll(".mark")) {
  mark.addEventListener("pointerenter", event => show(mark.dataset.id, event.clientX, event.clientY));
  mark.addEventListener("focus", () => showMark(mark));
  for (const end of ["pointerleave", "blur"]) mark.addEventListener(end, () => { tip.hidden = true; });
}
const asked = decodeURIComponent(location.hash).replace("#hover=", "");
for (const mark of document.querySelectorAll(".mark"))
  if (mark.dataset.id === asked) { showMark(mark); break; }
)js";
}
