#!/usr/bin/env bash
# Makes docs/pictures/witness.png: tags on the oval mask in place of its markers, rendered, with what AprilTag's library found.
# Needs a built retrolux and oiiotool (openimageio-tools).
set -euo pipefail
cd "$(dirname "$0")/.."
retrolux=build/release/cli/retrolux
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
$retrolux --quiet scene export oval --out "$work/scene"
$retrolux --quiet tags apriltag36h11 --size 30 --out "$work/scene/markers.json"
sed -i 's/"number": 0/"number": 7/; s/entrance_weight_iso20471/entrance_weight_ward2002/' "$work/scene/scene.json"
$retrolux --quiet render "$work/scene/scene.json" --spp 32 --out "$work/render"
$retrolux classify "$work/render/camera.png" --method apriltag36h11 --set "$work/scene/markers.json" --debug "$work/debug" --out "$work/detections.json"
oiiotool "$work/debug/tags.png" --cut 1140x1050+390+195 -o docs/pictures/witness.png
echo docs/pictures/witness.png
