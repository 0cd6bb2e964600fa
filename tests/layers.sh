#!/usr/bin/env bash
# Who may include whom: core <- materials <- scenes <- renderer <- analysis <- cli, core <- classifier <- analysis.
# And each heavy dependency is known to one or two files only.
set -u
cd "${1:?usage: layers.sh SOURCE_FOLDER}" || exit 2
bad=0

# forbid FOLDER REGEX: no file under FOLDER includes a path that begins with REGEX.
forbid() {
  [ -d "$1" ] || { echo "layers: no folder $1"; bad=1; return; }
  if grep -rnE --include='*.h' --include='*.cpp' "^ *# *include *[\"<]($2)" "$1"; then bad=1; fi
}

# only REGEX FILES...: of our own layers, only the files named include what REGEX says.
only() {
  local what=$1; shift
  local hits
  hits=$(grep -rlE --include='*.h' --include='*.cpp' "^ *# *include *[\"<]($what)" \
    core materials scenes renderer classifier analysis cli | grep -vxF "$(printf '%s\n' "$@")")
  [ -z "$hits" ] || { printf '%s includes %s\n' "$hits" "$what"; bad=1; }
}

forbid core       'materials/|scenes/|renderer/|classifier/|analysis/|cli/|tests/'
forbid materials  'scenes/|renderer/|classifier/|analysis/|cli/|tests/'
forbid scenes     'renderer/|classifier/|analysis/|cli/|tests/'
forbid renderer   'classifier/|analysis/|cli/|tests/'
forbid classifier 'materials/|scenes/|renderer/|analysis/|cli/|tests/'
forbid analysis   'cli/|tests/'
forbid cli        'tests/'

only 'embree3/'     renderer/ray_scene_impl.h renderer/bare_embree.cpp
only 'renderer/ray_scene_impl' renderer/ray_scene.cpp renderer/ray_geometry.cpp renderer/ray_packets.cpp
only 'OpenImageIO/' core/image_file.cpp
only 'tiny_gltf'    scenes/gltf_load.cpp scenes/gltf_mesh.cpp scenes/gltf_model.cpp scenes/gltf_write.cpp
only 'tbb/'         core/parallel.cpp
only 'assimp/'      scenes/mesh_import.cpp
only 'CGAL/'        scenes/mesh_reconstruct.cpp
only 'nlopt'        analysis/placement_refinement.cpp
only 'unsupported/Eigen' analysis/lobe_fit.cpp
only 'apriltag/'    classifier/april_tags.cpp
only 'opencv2/aruco' classifier/aruco_tags.cpp

[ $bad -eq 0 ] && echo "layers: every include points downwards"
exit $bad
