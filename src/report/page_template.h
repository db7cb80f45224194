#pragma once

namespace catoptric::report {

/// The page of html_report.h in the Mustache language: {{x}} is escaped, {{{x}}} is not, {{#x}}...{{/x}}
/// repeats.
inline constexpr const char* page_template = R"html(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; img-src data:">
<title>{{title}}</title>
<style>
:root { color-scheme: light dark; --ink: #1c1c1c; --paper: #ffffff; --soft: #5c5c5c; --line: #d0d0d0; --card: #f5f5f3; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e8e8e6; --paper: #17181a; --soft: #a9a9a6; --line: #404246; --card: #222427; }
}
body { margin: 0 auto; max-width: 60rem; padding: 1.5rem 1rem 3rem; color: var(--ink); background: var(--paper);
  font: 1rem/1.5 system-ui, sans-serif; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0 0 0.3rem; overflow-wrap: anywhere; }
h2 { font-size: 1.25rem; margin: 2.2rem 0 0.6rem; border-bottom: 1px solid var(--line); overflow-wrap: anywhere; }
p { max-width: 45rem; overflow-wrap: anywhere; }
.soft, figcaption, caption, footer { color: var(--soft); font-size: 0.92rem; }
dl { display: grid; grid-template-columns: minmax(9rem, max-content) 1fr; gap: 0.15rem 1.2rem; margin: 0.8rem 0; }
dt { color: var(--soft); }
dd { margin: 0; overflow-wrap: anywhere; font-variant-numeric: tabular-nums; }
dl.answer { background: var(--card); border-left: 4px solid #0072b2; padding: 0.8rem 1rem; }
dl.answer dd { font-weight: 600; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; margin: 0.8rem 0; font-size: 0.92rem; font-variant-numeric: tabular-nums; }
caption { text-align: left; padding-bottom: 0.3rem; }
th, td { padding: 0.2rem 0.7rem; border-bottom: 1px solid var(--line); text-align: left; vertical-align: top; }
th { white-space: nowrap; }
.n { text-align: right; white-space: nowrap; }
figure { margin: 1rem 0 1.6rem; }
.picture { background: #ffffff; border: 1px solid var(--line); border-radius: 4px; padding: 0.3rem; }
.picture svg { display: block; width: 100%; max-width: 800px; height: auto; margin: 0 auto; }
footer { margin-top: 3rem; border-top: 1px solid var(--line); padding-top: 0.6rem; overflow-wrap: anywhere; }
@media print {
  :root { color-scheme: light; --ink: #000000; --paper: #ffffff; --soft: #404040; --line: #b0b0b0; --card: #ffffff; }
  body { max-width: none; padding: 0; font-size: 10pt; }
  h2 { break-after: avoid; }
  figure, tr, dl.answer { break-inside: avoid; }
  figure { margin: 0.3rem 0 0.5rem; }
  .picture { border: none; padding: 0; }
  .picture svg { max-height: 9.6cm; }
  .wide { overflow: visible; }
}
</style>
</head>
<body>
<main>
<h1>{{title}}</h1>
{{#has_subtitle}}<p class="soft">{{subtitle}}</p>
{{/has_subtitle}}{{#has_facts}}<dl class="answer">
{{#facts}}<dt>{{name}}</dt><dd>{{value}}</dd>
{{/facts}}</dl>
{{/has_facts}}{{#sections}}<section>
<h2>{{heading}}</h2>
{{#paragraphs}}<p>{{text}}</p>
{{/paragraphs}}{{#has_facts}}<dl>
{{#facts}}<dt>{{name}}</dt><dd>{{value}}</dd>
{{/facts}}</dl>
{{/has_facts}}{{#tables}}<div class="wide"><table>
{{#has_caption}}<caption>{{caption}}</caption>
{{/has_caption}}<thead><tr>{{#columns}}<th scope="col"{{#number}} class="n"{{/number}}>{{heading}}</th>{{/columns}}</tr></thead>
<tbody>
{{#rows}}<tr>{{#cells}}<td{{#number}} class="n"{{/number}}>{{text}}</td>{{/cells}}</tr>
{{/rows}}</tbody>
</table></div>
{{/tables}}{{#figures}}<figure>
{{#drawn}}<div class="picture" role="img" aria-label="{{caption}}">{{{svg}}}</div>
{{/drawn}}{{^drawn}}<p class="soft">{{missing}}</p>
{{/drawn}}<figcaption>{{caption}}</figcaption>
</figure>
{{/figures}}</section>
{{/sections}}</main>
{{#has_footer}}<footer>{{footer}}</footer>
{{/has_footer}}</body>
</html>
)html";

}  // namespace catoptric::report
