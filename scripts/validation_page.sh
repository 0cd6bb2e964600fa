#!/usr/bin/env bash
# Writes the measured part of docs/validation.md: all that stands below its heading "As measured".
#   validation_page.sh [RETROLUX [PAGE [OPTIONS OF VALIDATE...]]]
# With a PAGE of its own the page in docs/ stays as it is. Exit code 3 if a check failed; needs node.
set -euo pipefail
cd "$(dirname "$0")/.."
retrolux=${1:-build/release/cli/retrolux}
page=${2:-docs/validation.md}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
"$retrolux" --quiet validate --out "$out" "${@:3}" >/dev/null || [ $? -eq 3 ]
node - "$out/validate.json" docs/validation.md "$page" <<'JS'
const fs = require("fs");
const [file, template, page] = process.argv.slice(2);
const json = JSON.parse(fs.readFileSync(file));
const number = (x) => String(Number(x.toPrecision(6)));
const cell = (text) => text.replaceAll("|", "\\|");
let text = fs.readFileSync(template, "utf8").split("\n## As measured")[0];
text += `\n## As measured\n\nVersion ${json.version}, seed 1: ${json.count - json.failed} of ${json.count} checks pass. "Off" is the distance from the expected value in units of the tolerance.\n`;
for (const group of [...new Set(json.checks.map((c) => c.group))]) {
  const checks = json.checks.filter((c) => c.group === group);
  const sources = new Set(checks.map((c) => c.source));
  text += `\n### ${group[0].toUpperCase()}${group.slice(1)}\n\nIndependent of what is tested: ${checks[0].independent_of}.\n`;
  if (sources.size === 1) text += `Expected: ${checks[0].source}.\n`;
  text += `\n| check | measured | expected | tolerance | unit | off |${sources.size > 1 ? " source |" : ""}\n|---|---|---|---|---|---|${sources.size > 1 ? "---|" : ""}\n`;
  for (const c of checks) {
    const off = Math.abs(c.measured - c.expected) / c.tolerance;
    text += `| ${c.pass ? "" : "**failed:** "}${cell(c.check)} | ${number(c.measured)} | ${number(c.expected)} | ${number(c.tolerance)} | ${c.unit} | ${off.toFixed(2)} |`;
    text += `${sources.size > 1 ? ` ${cell(c.source)} |` : ""}\n`;
  }
}
fs.writeFileSync(page, text);
process.exitCode = json.failed > 0 ? 3 : 0;
JS
echo "$page"
