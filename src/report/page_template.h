#pragma once

namespace catoptric::report {

/// The page of html_report.h in the Mustache language: {{x}} is escaped, {{{x}}} is not, {{#x}}...{{/x}}
/// repeats. The colours in brackets are those of plot_script.cpp's frames, grids and words, which follow the
/// reader's setting; curves and maps keep theirs.
inline constexpr const char* page_template = R"html(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; img-src data:{{#has_view}}; script-src 'nonce-catoptric'{{/has_view}}">
<title>{{title}}</title>
<style>
:root { color-scheme: light dark; --ink: #1c1c1c; --paper: #ffffff; --soft: #5c5c5c; --line: #d0d0d0; --card: #f5f5f3;
  --plot: #ffffff; --grid: #d4d4d4; --accent: #0072b2; --blue: #0072b2; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e8e8e6; --paper: #17181a; --soft: #a9a9a6; --line: #404246; --card: #222427; --plot: #222427;
    --grid: #44474c; --accent: #56b4e9; --blue: #3a9bd8; }
}
html { scroll-padding-top: 3.2rem; }
body { margin: 0 auto; max-width: 60rem; padding: 1.5rem 1rem 3rem; color: var(--ink); background: var(--paper);
  font: 1rem/1.5 system-ui, sans-serif; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0 0 0.3rem; overflow-wrap: anywhere; }
h2 { font-size: 1.25rem; margin: 2.2rem 0 0.6rem; border-bottom: 1px solid var(--line); overflow-wrap: anywhere; }
p { max-width: 45rem; overflow-wrap: anywhere; }
.soft, figcaption, caption, footer { color: var(--soft); font-size: 0.92rem; }
.origin { margin: 0 0 0.2rem; }
.verdict { font-size: 1.1rem; margin: 0.4rem 0 1rem; }
a { color: var(--accent); }
nav { position: sticky; top: 0; z-index: 1; background: var(--paper); border-bottom: 1px solid var(--line);
  padding: 0.4rem 0; font-size: 0.92rem; }
nav a { margin-right: 1.1rem; text-decoration: none; white-space: nowrap; display: inline-block; }
dl { display: grid; grid-template-columns: minmax(9rem, max-content) 1fr; gap: 0.15rem 1.2rem; margin: 0.8rem 0; }
dt { color: var(--soft); }
dd { margin: 0; overflow-wrap: anywhere; font-variant-numeric: tabular-nums; }
dl.answer { background: var(--card); border-left: 4px solid var(--accent); padding: 0.8rem 1rem; }
dl.answer dd { font-weight: 600; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; margin: 0.8rem 0; font-size: 0.92rem; font-variant-numeric: tabular-nums; }
caption { text-align: left; padding-bottom: 0.3rem; }
th, td { padding: 0.2rem 0.7rem; border-bottom: 1px solid var(--line); text-align: left; vertical-align: top; }
th { white-space: nowrap; }
.n { text-align: right; white-space: nowrap; }
summary { cursor: pointer; color: var(--accent); }
pre { background: var(--card); padding: 0.8rem 1rem; overflow-x: auto; font-size: 0.85rem; line-height: 1.35; }
figure { margin: 1rem 0 1.6rem; }
figcaption { max-width: 45rem; }
.picture { background: var(--plot); border: 1px solid var(--line); border-radius: 4px; padding: 0.3rem; }
.picture svg { display: block; width: 100%; max-width: 800px; height: auto; margin: 0 auto; }
.picture svg [fill='rgb(255, 255, 255)'], .picture svg [fill='#ffffff'] { fill: var(--plot); }
.picture svg [fill='rgb(  0,   0,   0)'], .picture svg [fill='black'], .picture svg [fill='#000000'],
.picture svg [fill='rgb(64,64,64)'] { fill: var(--ink); }
.picture svg [stroke='rgb(  0,   0,   0)'], .picture svg [stroke='black'], .picture svg [stroke='rgb( 64,  64,  64)'] { stroke: var(--ink); }
.picture svg [stroke='rgb(212, 212, 212)'] { stroke: var(--grid); }
.picture svg [stroke='rgb(  0, 114, 178)'] { stroke: var(--blue); color: var(--blue); }
.picture svg [color='rgb(  0, 114, 178)'] { color: var(--blue); }
.picture svg [color='black'], .picture svg [color='rgb(  0,   0,   0)'] { color: var(--ink); }
#view-3d { background: var(--plot); border: 1px solid var(--line); border-radius: 4px; overflow: hidden; }
#view-3d canvas { display: block; cursor: grab; }
#view-3d img { display: none; }
#view-3d p { padding: 1rem; }
footer { margin-top: 3rem; border-top: 1px solid var(--line); padding-top: 0.6rem; overflow-wrap: anywhere; }
@media (max-width: 40rem) {
  dl { grid-template-columns: 1fr; gap: 0; }
  dd { margin-bottom: 0.4rem; }
  dl.answer dd { margin-bottom: 0.5rem; }
}
@media print {
  :root { color-scheme: light; --ink: #000000; --paper: #ffffff; --soft: #404040; --line: #b0b0b0; --card: #ffffff;
    --plot: #ffffff; --grid: #d4d4d4; --accent: #000000; --blue: #0072b2; }
  body { max-width: none; padding: 0; font-size: 10pt; }
  nav { display: none; }
  h2 { break-after: avoid; }
  figure, tr, dl.answer { break-inside: avoid; }
  figure { margin: 0.3rem 0 0.5rem; }
  .picture, #view-3d { border: none; padding: 0; }
  .picture svg { max-height: 9.6cm; }
  #view-3d canvas { display: none; }
  #view-3d img { display: block; max-width: 100%; max-height: 9.6cm; margin: 0 auto; }
  .wide { overflow: visible; }
  table { font-size: 8pt; }
  th { white-space: normal; }
  th, td { padding: 0.1rem 0.4rem; }
  .listing::details-content { content-visibility: visible; height: auto; display: block; }
  pre { white-space: pre-wrap; font-size: 7.5pt; padding: 0; }
}
</style>
</head>
<body>
<main>
{{#has_origin}}<p class="soft origin">{{origin}}</p>
{{/has_origin}}<h1>{{title}}</h1>
{{#has_subtitle}}<p class="verdict">{{subtitle}}</p>
{{/has_subtitle}}{{#has_facts}}<dl class="answer">
{{#facts}}<dt>{{name}}</dt><dd>{{value}}</dd>
{{/facts}}</dl>
{{/has_facts}}{{#has_contents}}<nav>{{#sections}}<a href="#{{place}}">{{heading}}</a>{{/sections}}</nav>
{{/has_contents}}{{#sections}}<section id="{{place}}">
<h2>{{heading}}</h2>
{{#paragraphs}}<p>{{text}}</p>
{{/paragraphs}}{{#has_view}}<figure>
<div id="view-3d" role="img" aria-label="{{view_caption}}"><img alt="{{view_caption}}"><p class="missing" hidden>This browser draws no WebGL, so there is no view in space; the mirror is in reflector.step and in the figures below.</p><noscript><p>The view in space needs scripts, which are switched off.</p></noscript></div>
<figcaption>{{view_caption}}</figcaption>
</figure>
{{/has_view}}{{#has_facts}}<dl>
{{#facts}}<dt>{{name}}</dt><dd>{{value}}</dd>
{{/facts}}</dl>
{{/has_facts}}{{#tables}}{{#is_folded}}<details><summary>{{folded}}</summary>
{{/is_folded}}<div class="wide"><table>
{{#has_caption}}<caption>{{caption}}</caption>
{{/has_caption}}<thead><tr>{{#columns}}<th scope="col"{{#number}} class="n"{{/number}}>{{heading}}</th>{{/columns}}</tr></thead>
<tbody>
{{#rows}}<tr>{{#cells}}<td{{#number}} class="n"{{/number}}>{{text}}</td>{{/cells}}</tr>
{{/rows}}</tbody>
</table></div>
{{#is_folded}}</details>
{{/is_folded}}{{/tables}}{{#figures}}<figure>
{{#drawn}}<div class="picture" role="img" aria-label="{{caption}}">{{{svg}}}</div>
{{/drawn}}{{^drawn}}<p class="soft">{{missing}}</p>
{{/drawn}}<figcaption>{{caption}}</figcaption>
</figure>
{{/figures}}{{#has_links}}<ul>
{{#links}}<li><a href="{{address}}">{{words}}</a></li>
{{/links}}</ul>
{{/has_links}}{{#listings}}<details class="listing"><summary>{{caption}}</summary>
<pre>{{text}}</pre>
</details>
{{/listings}}</section>
{{/sections}}</main>
{{#has_footer}}<footer>{{footer}}</footer>
{{/has_footer}}{{#has_view}}<script type="application/json" id="view-3d-data">{{{view_data}}}</script>
<script nonce="catoptric">/*
{{{three_js_licence}}}
*/
{{{three_js}}}</script>
<script nonce="catoptric">{{{orbit_controls_js}}}</script>
<script nonce="catoptric">{{{view_script}}}</script>
{{/has_view}}</body>
</html>
)html";

}  // namespace catoptric::report
