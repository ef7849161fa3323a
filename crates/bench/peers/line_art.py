"""Blender's Line Art on a mesh, eye after eye: its strokes and its time, for suite `lines`.

The file that it is given is JSON:

    {"positions": [[x, y, z], ...], "triangles": [[a, b, c], ...], "crease": 40.0 or null (degrees), "target": [x, y, z],
     "eyes": [[x, y, z], ...]}

For each eye, which sees 30 degrees by 720 pixels with `target` in the middle, it prints a line of JSON:

    {"seconds": 0.0134, "strokes": [[[x, y, z], ...], ...]}

`seconds` is what Blender takes from a moved camera to new strokes, by one thread; `strokes` are on the mesh's edges.
"""

import argparse
import json
import math
import os
import time

# One thread, as our own lines are found by. Blender asks how many there are when it is loaded.
if hasattr(os, "sched_setaffinity"):
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})

import bpy
from mathutils import Vector


def scene_of(mesh):
    """An empty scene with the mesh, a camera, and a Grease Pencil object whose lines the modifier makes."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = 720
    shape = bpy.data.meshes.new("mesh")
    shape.from_pydata(mesh["positions"], [], mesh["triangles"])
    shape.update()
    thing = bpy.data.objects.new("mesh", shape)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.angle = math.radians(30)
    pencil = bpy.data.grease_pencils.new("lines")
    pencil.layers.new("lines").frames.new(scene.frame_current)
    material = bpy.data.materials.new("lines")
    bpy.data.materials.create_gpencil_data(material)
    pencil.materials.append(material)
    lines = bpy.data.objects.new("lines", pencil)
    for item in (thing, camera, lines):
        scene.collection.objects.link(item)
    scene.camera = camera
    art = lines.modifiers.new("lines", "LINEART")
    art.source_type, art.source_object = "OBJECT", thing
    art.target_layer, art.target_material = "lines", material
    art.use_contour = art.use_loose = True
    art.use_crease = mesh["crease"] is not None
    if art.use_crease:
        # The angle between faces, where ours is that of their normals.
        art.crease_threshold = math.pi - math.radians(mesh["crease"])
    art.use_material = art.use_edge_mark = art.use_intersection = False
    # What is seen, as exactly as it can.
    art.use_multiple_levels, art.level_start = False, 0
    art.stroke_depth_offset = art.smooth_tolerance = art.split_angle = 0.0
    art.chaining_image_threshold = 0.0
    return camera, lines


def look(camera, eye, target):
    away = Vector(target) - Vector(eye)
    camera.location = eye
    camera.rotation_euler = away.to_track_quat("-Z", "Y").to_euler()
    camera.data.clip_start, camera.data.clip_end = 0.01 * away.length, 100 * away.length


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("mesh")
    with open(parser.parse_args().mesh, encoding="utf-8") as file:
        mesh = json.load(file)
    camera, lines = scene_of(mesh)
    for eye in mesh["eyes"]:
        look(camera, eye, mesh["target"])
        start = time.perf_counter()
        bpy.context.view_layer.update()
        drawn = lines.evaluated_get(bpy.context.evaluated_depsgraph_get())
        seconds = time.perf_counter() - start
        strokes = drawn.data.layers[0].frames[0].drawing.strokes
        strokes = [[list(point.position) for point in stroke.points] for stroke in strokes]
        print(json.dumps({"seconds": seconds, "strokes": strokes}), flush=True)


if __name__ == "__main__":
    main()
