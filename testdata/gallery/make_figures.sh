#!/bin/bash
# Remakes the chapter's figures 14.5 and 14.7 to 14.9 on a scan, a formula and polygon surfaces, and one of sharp edges:
#   testdata/gallery/make_figures.sh DELVOX CT_AVM.nii.gz MESHES [FOLDER]
# MESHES holds CGAL's samples (data/meshes in Debian's libcgal-dev, /usr/share/doc/libcgal-dev/data.tar.gz). Needs
# python3-vtk9 and xvfb. Pictures go to FOLDER, by default this one.
set -euo pipefail
if [ $# -lt 3 ]; then
  sed -n 's/^#  *testdata/usage: testdata/p' "$0" >&2
  exit 2
fi
delvox=$(realpath "$1") scan=$(realpath "$2") meshes=$(realpath "$3")
here=$(dirname "$(realpath "$0")")
pictures=$(realpath "${4:-$here}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# A ball with knobs and handles: smooth, so that Smooth can have its way everywhere.
knob="sin(4*x)*cos(4*y)+sin(4*y)*cos(4*z)+sin(4*z)*cos(4*x)+0.8*(x^2+y^2+z^2-1.7^2)"

render() { xvfb-run -a /usr/bin/python3 "$here/render.py" "$@"; }
run() { "$delvox" "$@" --quiet || [ $? -eq 5 ]; }  # 5: a coarse mesh that lacks a handle is what is to be seen

figure_14_5() {
  for size in 6 3 1.5; do run surface "$scan" --iso 180 --largest --size $size -o vessels_$size.ply; done
  render vessels_6.ply vessels_3.ply vessels_1.5.ply --from=anterior --size 380x420 --colours 64 \
    -o "$pictures/figure_14_5.png"
}

figure_14_7() {
  local box=--box=-2.5:2.5,-2.5:2.5,-2.5:2.5
  run surface --implicit "$knob" $box --size 0.3 --min-angle 0 -o none.ply
  run surface --implicit "$knob" $box --size 0.3 --min-angle 0 --max-roughness 25 -o smooth.ply
  run surface --implicit "$knob" $box --size 0.3 --max-roughness 25 -o smooth_quality.ply
  render none.ply smooth.ply smooth_quality.ply --histogram --size 420x500 --colours 64 -o "$pictures/figure_14_7.png"
}

figures_14_8_and_14_9() {
  local view=(--up 0,1,0 --from=-0.6,0.5,1 --size 380x340)
  for name in elephant bunny00 armadillo; do
    run convert "$meshes/$name.off" -o $name.ply
    run remesh "$meshes/$name.off" -o ${name}_remeshed.ply
    run tet "$meshes/$name.off" -o $name.vtu
  done
  render {elephant,bunny00,armadillo}.ply {elephant,bunny00,armadillo}_remeshed.ply "${view[@]}" --columns 3 \
    --colours 64 -o "$pictures/figure_14_8.png"
  render {elephant,bunny00,armadillo}.vtu "${view[@]}" --cut 0,0,1 --colours 96 -o "$pictures/figure_14_9.png"
}

sharp_edges() {
  for name in fandisk joint anchor; do run tet "$meshes/$name.off" --feature-angle 60 -o $name.vtu; done
  render {fandisk,joint,anchor}.vtu --size 420x380 --colours 64 -o "$pictures/sharp_edges.png"
}

figure_14_5
figure_14_7
figures_14_8_and_14_9
sharp_edges
