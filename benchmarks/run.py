"""Measure, print ratios and renew docs/benchmarks.md.

python benchmarks/run.py [--only transfer] [--json FILE]
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import resource
from pathlib import Path
from typing import Any

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

SUITES = ("transfer", "signals", "rigging", "detail")
ROOT = Path(__file__).resolve().parents[1]


def table(rows: list[dict[str, Any]]) -> str:
    lines = [
        "| name | what | found | ratio | against | to reach | stretch |",
        "|---|---|---|---|---|---|---|",
    ]
    for r in rows:
        value = r.get("value") or f"{1000 * r['seconds']:.2f} ms"
        ratio = f"{r['ratio']:.2f}" if r.get("ratio") else ""
        reach, stretch = (f"{g:.3g}" if g else "" for g in r.get("goal") or (None, None))
        cells = (r["name"], r["what"], value, ratio, r.get("against", ""), reach, stretch)
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--only", choices=SUITES)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    rows: list[dict[str, Any]] = []
    for suite in [options.only] if options.only else SUITES:
        found = importlib.import_module(f"bench_{suite}").run()
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        rows += [{**row, "memory_mb": row.get("memory_mb") or round(peak)} for row in found]
        page = ROOT / "docs" / "benchmarks.md"
        text = page.read_text(encoding="utf-8")
        before, _, rest = text.partition(f"<!-- {suite} -->")
        block = f"<!-- {suite} -->\n{table(found)}\n<!-- /{suite} -->"
        page.write_text(before + block + rest.partition(f"<!-- /{suite} -->")[2], encoding="utf-8")
        print(table(found))
    if options.json:
        options.json.write_text(json.dumps({"rows": rows}, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
