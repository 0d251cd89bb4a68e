# SPDX-License-Identifier: Apache-2.0
"""The heap in Cycles: blender -b --factory-startup --python cycles.py -- FOLDER SAMPLES SEED THREADS WIDTH HEIGHT OUT.exr
GRAINS MILLIMETRES. GRAINS is diffuse, or with that Radius: burley, random_walk or fixed_radius.
Reads the PLY files of geometry.py; every number is that of scene.yaml, which is y up, as the camera here is."""
import math
import struct
import sys

import bpy
import mathutils

folder, samples, seed, threads, width, height, output, grains, millimetres = sys.argv[sys.argv.index("--") + 1 :]


def read_ply(name):
    with open(folder + "/" + name, "rb") as file:
        data = file.read()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    counts, columns = [], 0
    for line in data[:end].decode().split("\n"):
        words = line.split()
        counts += [int(words[2])] if words[:1] == ["element"] else []
        columns += words[:2] == ["property", "float"]
    rows = [struct.unpack_from("<%df" % columns, data, end + 4 * columns * i) for i in range(counts[0])]
    begin = end + 4 * columns * counts[0]
    faces = [struct.unpack_from("<3i", data, begin + 13 * i + 1) for i in range(counts[1] if len(counts) > 1 else 0)]
    return rows, faces


def diffuse(name, albedo):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    shader, out = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
    shader.inputs["Color"].default_value = (albedo, albedo, albedo, 1.0)
    material.node_tree.links.new(shader.outputs[0], out.inputs["Surface"])
    return material


def subsurface(name, albedo):
    """What the radius means is said in translucent.py."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    shader, out = nodes.new("ShaderNodeSubsurfaceScattering"), nodes.new("ShaderNodeOutputMaterial")
    methods = {"burley": "BURLEY", "random_walk": "RANDOM_WALK", "fixed_radius": "RANDOM_WALK_FIXED_RADIUS"}
    shader.falloff = methods[grains]
    shader.inputs["Color"].default_value = (albedo, albedo, albedo, 1.0)
    shader.inputs["Radius"].default_value = (1.0, 1.0, 1.0)
    shader.inputs["Scale"].default_value = 1e-3 * float(millimetres)
    material.node_tree.links.new(shader.outputs[0], out.inputs["Surface"])
    return material


def mesh_of(name, albedo, smooth):
    rows, faces = read_ply(name + ".ply")
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(rows, [], faces)
    translucent = name == "grain" and grains != "diffuse"
    mesh.materials.append((subsurface if translucent else diffuse)(name, albedo))
    mesh.polygons.foreach_set("use_smooth", [smooth] * len(mesh.polygons))
    mesh.update()
    return mesh


def add(name, data):
    thing = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def looking(position, target):
    position, target = mathutils.Vector(position), mathutils.Vector(target)
    turn = (target - position).to_track_quat("-Z", "Y")
    return mathutils.Matrix.Translation(position) @ turn.to_matrix().to_4x4()


def camera_looking(position, target):
    """The same with y up, which to_track_quat does not promise."""
    back = (mathutils.Vector(position) - mathutils.Vector(target)).normalized()
    right = mathutils.Vector((0.0, 1.0, 0.0)).cross(back).normalized()
    up = back.cross(right)
    turn = mathutils.Matrix((right, up, back)).transposed().to_4x4()
    return mathutils.Matrix.Translation(mathutils.Vector(position)) @ turn


bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
grain = mesh_of("grain", 0.8, True)
for row in read_ply("grains.ply")[0]:
    turn = mathutils.Quaternion((row[6], row[3], row[4], row[5]))
    place = mathutils.Matrix.Translation(row[:3]) @ turn.to_matrix().to_4x4() @ mathutils.Matrix.Scale(row[7], 4)
    add("grain", grain).matrix_world = place
add("bowl", mesh_of("bowl", 0.5, True))
add("ground", mesh_of("ground", 0.3, False))

lamp = bpy.data.lights.new("lamp", "AREA")
lamp.shape, lamp.size = "SQUARE", 0.1
lamp.energy = 20.0 * 4.0 * 0.1 * 0.1  # Cycles gives an area lamp of power P the radiance P / (4 A)
add("lamp", lamp).matrix_world = looking((-0.12, 0.22, 0.04), (0.0, 0.03, 0.0))

world = bpy.data.worlds.new("world")
world.use_nodes = True
world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.35, 0.35, 0.35, 1.0)
scene.world = world

camera = bpy.data.cameras.new("camera")
camera.sensor_fit, camera.angle = "VERTICAL", math.radians(14.0)
camera.clip_start = 0.001
eye = add("camera", camera)
eye.matrix_world = camera_looking((0.0, 0.15, 0.135), (0.0, 0.031, 0.0))
scene.camera = eye

render, cycles = scene.render, scene.cycles
render.engine = "CYCLES"
render.resolution_x, render.resolution_y, render.resolution_percentage = int(width), int(height), 100
render.threads_mode, render.threads = "FIXED", int(threads)
cycles.device = "CPU"
cycles.samples, cycles.seed = int(samples), int(seed)
cycles.use_adaptive_sampling = cycles.use_denoising = False
cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = 8
cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
scene.view_settings.view_transform = "Raw"
settings = render.image_settings
settings.file_format, settings.color_mode, settings.color_depth, settings.exr_codec = "OPEN_EXR", "RGB", "32", "ZIP"
render.use_stamp = False
render.filepath, render.use_file_extension = output, False
bpy.ops.render.render(write_still=True)
