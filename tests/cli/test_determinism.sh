# SPDX-License-Identifier: Apache-2.0
# One scene, one set of bytes: whatever the threads, the split into parts, or the second run.
cat >scene.yaml <<'Y'
tsuya: 1
film: { size: [61, 37] }
render: { samples: 64, seed: 3 }
camera: { position: [0, 0.05, 0.12], look_at: [0, 0, 0], vfov: 40 }
assets:
  ball: { shape: sphere, radius: 0.01, divisions: 32 }
  floor: { shape: plane, size: [0.1, 0, 0.1] }
materials:
  skin: { model: cdrf, color: [0.8, 0.7, 0.6], mean_free_path: 1.5 }
  glass: { model: surface, transmission_weight: 1, specular_roughness: 0.2 }
  grey: { model: surface, base_color: 0.5 }
  milk: { model: walk, preset: skim_milk }
  wax: { model: walk, boundary: dielectric, subsurface_color: [0.8, 0.6, 0.4], subsurface_radius: 3 }
  ice: { model: surface, transmission_weight: 1, transmission_depth: 0.01, transmission_scatter: [1, 2, 3] }
  probed: { model: cdrf, color: [0.8, 0.7, 0.6], mean_free_path: 1.5, mean_free_path_scale: [1, 0.5, 0.2], evaluate: probe }
  local: { model: cdrf, color: 0.8, mean_free_path: 1.5, evaluate: local, kernel: gaussian }
  grain: { model: cdrf, color: 0.8, moisture: { soak: { minutes: 30, celsius: 20 }, cooked: 0.5 } }
  layers:
    { model: surface, base_color: [0.7, 0.5, 0.3], base_diffuse_roughness: 0.8, base_metalness: 0.3, specular_roughness: 0.3,
      specular_roughness_anisotropy: 0.6, coat_weight: 0.6, coat_color: [0.9, 0.7, 0.5], coat_roughness: 0.1,
      fuzz_weight: 0.4, emission_luminance: 0.02, opacity: 0.9 }
  flesh: { model: surface, subsurface_weight: 0.7, subsurface_color: [0.8, 0.5, 0.4], subsurface_radius: 2, coat_weight: 1 }
  jelly: { model: surface, subsurface_weight: 1, subsurface_color: [0.8, 0.5, 0.4], subsurface_radius: 2, subsurface_evaluate: walk }
  leaf: { model: surface, thin_walled: true, subsurface_weight: 1, subsurface_color: [0.3, 0.6, 0.2], transmission_weight: 0.2 }
objects:
  - { mesh: ball, material: milk, translate: [-0.03, 0.01, 0.01] }
  - { mesh: ball, material: wax, translate: [0.02, 0.01, 0.015] }
  - { mesh: ball, material: ice, translate: [0, 0.008, 0.03] }
  - { mesh: ball, material: skin, translate: [-0.012, 0.01, 0] }
  - { mesh: ball, material: glass, translate: [0.012, 0.01, 0] }
  - { mesh: ball, material: probed, translate: [-0.03, 0.01, -0.03], scale: [1, 0.7, 0.6], rotate: [0, 20, 30] }
  - { mesh: ball, material: local, translate: [-0.01, 0.01, -0.03], scale: [0.8, 0.8, 0.8] }
  - { mesh: ball, material: grain, translate: [0.008, 0.01, -0.03], scale: [1, 0.5, 0.5] }
  - { mesh: ball, material: layers, translate: [0.03, 0.01, -0.03] }
  - { mesh: ball, material: flesh, translate: [-0.02, 0.03, -0.05], scale: [0.7, 0.7, 0.7] }
  - { mesh: ball, material: jelly, translate: [0, 0.03, -0.05], scale: [0.7, 0.7, 0.7] }
  - { mesh: ball, material: leaf, translate: [0.02, 0.03, -0.05], scale: [0.7, 0.7, 0.1] }
  - { mesh: floor, material: grey }
lights:
  - { type: environment, radiance: 0.3 }
  - { type: rectangle, center: [-0.1, 0.1, 0], target: [0, 0, 0], size: [0.05, 0.05], radiance: 10 }
Y
for threads in 1 2 3; do
    expect 0 "$tsuya" render scene.yaml -o "t$threads.exr" --threads $threads --progress none
done
same t1.exr t2.exr
same t1.exr t3.exr
expect 0 "$tsuya" render scene.yaml -o a.exr --samples 0-31 --threads 2
expect 0 "$tsuya" render scene.yaml -o b.exr --samples 32-63 --threads 1
expect 0 "$tsuya" merge b.exr a.exr -o merged.exr
same t1.exr merged.exr
expect 0 "$tsuya" render scene.yaml -o whole.exr --samples 0-63
same t1.exr whole.exr

expect 0 "$tsuya" render scene.yaml -o crop.exr --crop 20,9,45,30 --threads 3
expect 0 "$tsuya" render scene.yaml -o crop1.exr --crop 20,9,45,30 --threads 1
same crop.exr crop1.exr

# A part of a part: 0-15 and 16-31 join to the same part as 0-31.
expect 0 "$tsuya" render scene.yaml -o c.exr --samples 0-15
expect 0 "$tsuya" render scene.yaml -o d.exr --samples 16-31
expect 0 "$tsuya" merge c.exr d.exr -o cd.exr
same a.exr cd.exr

# What cannot be joined says why.
expect 4 "$tsuya" merge a.exr a.exr -o bad.exr
says "0-31"
expect 4 "$tsuya" merge a.exr t1.exr -o bad.exr
expect 0 "$tsuya" render scene.yaml -o other.exr --samples 32-63 --seed 4
expect 4 "$tsuya" merge a.exr other.exr -o bad.exr
says "other.exr"
expect 0 "$tsuya" render scene.yaml -o other.exr --samples 32-63 --isa sse4.2
expect 4 "$tsuya" merge a.exr other.exr -o bad.exr
says "tsuya/isa"
absent bad.exr

# The picture holds its scene, and that scene makes the picture.
expect 0 "$tsuya" info t1.exr --recipe
cp out.txt again.yaml
expect 0 "$tsuya" render again.yaml -o again.exr
same t1.exr again.exr
# With overrides too: they are in the recipe's values, and told in it.
expect 0 "$tsuya" render scene.yaml -o o1.exr --spp 4 --set materials.grey.base_color=0.2
expect 0 "$tsuya" info o1.exr --recipe
cp out.txt again.yaml
expect 0 "$tsuya" render again.yaml -o o2.exr
same o1.exr o2.exr
expect 0 "$tsuya" info o2.exr --json
prints "--set materials.grey.base_color=0.2"
expect 0 "$tsuya" info t1.exr --json
prints '"tsuya/samples": "0-63"'

# Textures: neither threads nor what fits in memory nor who converted them changes a bit.
expect 0 "$tsuya" develop t1.exr -o fill.0001.png
expect 0 "$tsuya" develop o1.exr -o fill.0002.png
cat >textured.yaml <<'Y'
tsuya: 1
film: { size: [61, 37] }
render: { samples: 16 }
timeline: { start: 1, end: 4 }
camera: { position: [0, 0.05, 0.12], look_at: [0, 0, 0], vfov: 40 }
assets:
  ball: { shape: sphere, radius: 0.01, divisions: 32 }
  floor: { shape: plane, size: [0.1, 0, 0.1] }
  fill: { frames: fill.####.png, fps: 12, loop: true, interpolate: linear }
materials:
  skin: { model: cdrf, color: { texture: fill }, mean_free_path: 1.5 }
  grey: { model: surface, base_color: { texture: fill, mapping: triplanar, size: 0.03 }, specular_roughness: { texture: fill, channel: luminance } }
objects:
  - { mesh: ball, material: skin, translate: [-0.012, 0.01, 0] }
  - { mesh: floor, material: grey }
lights:
  - { type: environment, radiance: 0.3 }
Y
expect 0 "$tsuya" render textured.yaml --set frame=2 -o x1.exr --threads 1 --cache first --progress none
expect 0 "$tsuya" render textured.yaml --set frame=2 -o x2.exr --threads 3 --cache first --progress none --texture-cache 16MB
expect 0 "$tsuya" render textured.yaml --set frame=2 -o x3.exr --threads 2 --cache second --progress none --samples 0-15
same x1.exr x2.exr
same x1.exr x3.exr
expect 0 "$tsuya" render textured.yaml --set frame=4 -o x4.exr --cache /proc/nowhere --progress none
says "cannot be kept"
expect 0 "$tsuya" render textured.yaml --set frame=4 -o x5.exr --cache first --progress none
same x4.exr x5.exr
expect 2 "$tsuya" render textured.yaml -o bad.exr --texture-cache 1XB
says "512MB"
expect 2 "$tsuya" render textured.yaml -o bad.exr --texture-cache 1kB
