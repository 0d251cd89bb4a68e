# SPDX-License-Identifier: Apache-2.0
"""In Blender: imports each FILE=VERTICES after `--`; prints `imported FILE` when it holds so many."""
import sys

import bpy
import numpy

if not hasattr(numpy, "bool"):
    numpy.bool = bool  # Blender 3.4's glTF importer names what NumPy 1.24 has removed
IMPORTERS = {"glb": lambda f: bpy.ops.import_scene.gltf(filepath=f), "ply": lambda f: bpy.ops.import_mesh.ply(filepath=f),
             "obj": lambda f: bpy.ops.wm.obj_import(filepath=f)}
for argument in sys.argv[sys.argv.index("--") + 1:]:
    path, vertices = argument.split("=")
    bpy.ops.wm.read_factory_settings(use_empty=True)
    IMPORTERS[path.rsplit(".", 1)[1]](path)
    found = sum(len(o.data.vertices) for o in bpy.data.objects if o.type == "MESH")
    print("imported" if found == int(vertices) else f"{found} vertices in", path, flush=True)
