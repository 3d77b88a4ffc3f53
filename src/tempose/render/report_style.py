"""How a report looks: the tokens of the themes as CSS."""

from __future__ import annotations

_LIGHT = (
    "--app:#f6f7f9;--panel:#ffffff;--line:#d5d9e0;--text:#16181d;--text-2:#434a56;--text-3:#5d6573;"
    "--accent:#4650c8;--good:#176f40;--warning:#7d5f00;--error:#c0291f;"
    "--s0:#4650c8;--s1:#b92f52;--s2:#176f40;--s3:#a64e00;--s4:#0a6f94;--s5:#7a6300"
)
_DARK = (
    "--app:#0e1013;--panel:#15171b;--line:#262a31;--text:#e8eaed;--text-2:#b1b7c1;--text-3:#8b929e;"
    "--accent:#8b9aff;--good:#5cc98b;--warning:#e9c64b;--error:#ff7b72;"
    "--s0:#8b9aff;--s1:#f47d95;--s2:#5cc98b;--s3:#ff9f45;--s4:#52c3ea;--s5:#dcc56a"
)

PAGE_STYLE = (
    f":root{{{_LIGHT}}}@media(prefers-color-scheme:dark){{:root{{{_DARK}}}}}"
    "*{box-sizing:border-box}"
    "body{margin:0;background:var(--app);color:var(--text-2);"
    "font:14px/1.55 Inter,system-ui,-apple-system,'Segoe UI',sans-serif;font-variant-numeric:tabular-nums}"
    "header,main{max-width:1180px;margin:0 auto;padding:0 24px}"
    "header{padding-top:36px}"
    "h1{margin:0;color:var(--text);font-size:24px;line-height:32px;font-weight:600;letter-spacing:-.01em}"
    ".subtitle{margin:4px 0 0;color:var(--text-3)}"
    "nav{display:flex;flex-wrap:wrap;gap:4px 18px;margin-top:18px;padding-bottom:12px;"
    "border-bottom:1px solid var(--line)}"
    "a{color:var(--accent);text-decoration:none}a:hover{text-decoration:underline}"
    "a:focus-visible{outline:2px solid var(--accent);outline-offset:2px}"
    "section{margin:32px 0}"
    "h2{margin:0 0 10px;color:var(--text);font-size:16px;line-height:24px;font-weight:600}"
    "p{max-width:76ch;margin:8px 0}"
    "figure{margin:16px 0}"
    "figcaption{margin-top:6px;color:var(--text-3);font-size:12px}"
    "img,video{display:block;max-width:100%;height:auto;border:1px solid var(--line);border-radius:6px}"
    ".wide{overflow-x:auto}"
    "table{border-collapse:collapse;min-width:40%}"
    "th,td{padding:6px 22px 6px 0;text-align:left;border-bottom:1px solid var(--line);white-space:nowrap}"
    "th{color:var(--text-3);font-weight:500;font-size:12px}"
    "td{color:var(--text)}.n{text-align:right}"
    ".good{color:var(--good)}.warning{color:var(--warning)}.error{color:var(--error)}"
    ".tiles{display:flex;flex-wrap:wrap;gap:10px;margin:14px 0}"
    ".tile{min-width:132px;padding:10px 14px;background:var(--panel);border:1px solid var(--line);"
    "border-radius:6px}"
    ".tile dt{color:var(--text-3);font-size:12px}"
    ".tile dd{margin:2px 0 0;font-size:18px;line-height:26px;font-weight:600;color:var(--text)}"
    ".tile.good dd{color:var(--good)}.tile.warning dd{color:var(--warning)}.tile.error dd{color:var(--error)}"
    ".charts{display:flex;flex-wrap:wrap;gap:20px 28px}"
    ".chart{max-width:100%;height:auto}"
    "@media print{nav{display:none}section{break-inside:avoid}}"
)
"""Rules of the page; colours follow what the reader's system prefers."""
