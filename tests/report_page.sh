#!/usr/bin/env bash
# Opens a report in headless Chromium and checks that the page is whole (analysis/report/check_page.mjs):
#     report_page.sh REPORT.html [SCREENSHOT_FOLDER]
# Exit codes: 0 good, 1 the page is broken, 2 something is not installed.
set -eu
report=${1:?usage: report_page.sh REPORT.html [SCREENSHOT_FOLDER]}
pictures=${2:-$(dirname "$report")/report_page}
page=$(cd "$(dirname "$0")/../analysis/report" && pwd)
chromium=${CHROMIUM:-/usr/bin/chromium}

missing() { echo "report_page: $1; run scripts/setup.sh" >&2; exit 2; }
[ -x "$chromium" ] || missing "no browser at $chromium (package chromium)"
command -v node > /dev/null || missing "node is not installed (package nodejs)"
[ -d "$page/node_modules/playwright-core" ] || missing "playwright-core is not installed (npm ci in analysis/report)"

mkdir -p "$pictures"
exec node "$page/check_page.mjs" "$chromium" "$report" "$pictures"
