#!/usr/bin/env bash
# Makes the pictures of README and docs from a finished marker study:
#   scripts/doc_pictures.sh STUDY_FOLDER
# For each camera the kept pictures of the reference pose, frontal, oblique (45 degrees) and at the rim (80 degrees), side by side; dark levels are
# raised (gamma 2.2) so that the mask can be seen. Needs oiiotool (openimageio-tools) and node.
set -euo pipefail
study=$(realpath "${1:?usage: doc_pictures.sh STUDY_FOLDER}")
cd "$(dirname "$0")/.."
mkdir -p docs/pictures
node -e '
  const kept = JSON.parse(require("fs").readFileSync(process.argv[1] + "/summary.json")).kept;
  const cameras = [...new Set(kept.map(k => k.camera))];
  for (const camera of cameras) {
    const files = ["frontal", "oblique", "rim"].map(kind => kept.find(k => k.camera === camera && k.pose === "reference" && k.kind === kind));
    if (files.every(Boolean)) console.log(camera, ...files.map(k => k.file));
  }' "$study" | while read -r camera frontal oblique rim; do
  oiiotool "$study/$frontal" "$study/$oblique" "$study/$rim" --mosaic:pad=4 3x1 --powc 0.4545 --resize:filter=box 972x240 -o "docs/pictures/$camera.png"
  echo "docs/pictures/$camera.png"
done
