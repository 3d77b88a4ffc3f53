"""Runs inside Blender's own Python: open a file, look at the mesh, turn a joint on some frames, save.

python blender_edit.py '{"open": "rig.glb", "fps": 30, "look": [0, 5], "points": "seen.npz",
                         "joint": "left_upper_arm", "frames": [3, 4], "degrees": 40, "save": "edited.glb"}'
"""

import json
import math
import sys

import bpy
import numpy as np
from mathutils import Quaternion


def open_file(path, fps):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = round(fps)
    if path.endswith(".bvh"):
        bpy.ops.import_anim.bvh(filepath=path, rotate_mode="QUATERNION", update_scene_duration=True)
    elif path.endswith(".glb"):
        bpy.ops.import_scene.gltf(filepath=path)
    else:
        bpy.ops.wm.usd_import(filepath=path, set_frame_range=True)


def first_frame(path):
    """Frame of the scene that is frame 0 of the file."""
    return 1 if path.endswith(".bvh") else 0


def look(frames, first):
    """World positions of the mesh in some frames, in the axes of glTF and of our clips."""
    seen = []
    for frame in frames:
        bpy.context.scene.frame_set(first + frame)
        graph = bpy.context.evaluated_depsgraph_get()
        # what an importer adds for display has no modifier
        obj = next(o for o in bpy.data.objects if o.type == "MESH" and o.modifiers)
        shown = obj.evaluated_get(graph)
        V = np.zeros(3 * len(shown.data.vertices), np.float32)
        shown.data.vertices.foreach_get("co", V)
        place = np.array(shown.matrix_world)
        V = V.reshape(-1, 3) @ place[:3, :3].T + place[:3, 3]
        seen.append(V[:, [0, 2, 1]] * [1, 1, -1])
    return np.array(seen)


def turn(joint, frames, degrees, first):
    armature = next(o for o in bpy.data.objects if o.type == "ARMATURE")
    bone = armature.pose.bones[joint]
    for frame in frames:
        bpy.context.scene.frame_set(first + frame)
        bone.rotation_quaternion = bone.rotation_quaternion @ Quaternion((1, 0, 0), math.radians(degrees))
        bone.keyframe_insert("rotation_quaternion", frame=first + frame)


def save_file(path, count, first):
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = first, first + count - 1
    if path.endswith(".bvh"):
        armature = next(o for o in bpy.data.objects if o.type == "ARMATURE")
        bpy.context.view_layer.objects.active = armature
        bpy.ops.export_anim.bvh(filepath=path, frame_start=scene.frame_start, frame_end=scene.frame_end)
    elif path.endswith(".glb"):
        bpy.ops.export_scene.gltf(
            filepath=path, export_force_sampling=True, export_optimize_animation_size=False
        )
    else:
        bpy.ops.wm.usd_export(filepath=path, export_animation=True, only_deform_bones=False)


def main():
    order = json.loads(sys.argv[-1])
    open_file(order["open"], order["fps"])
    first = first_frame(order["open"])
    if "points" in order:
        np.savez(order["points"], vertices=look(order["look"], first))
    if "joint" in order:
        turn(order["joint"], order["frames"], order["degrees"], first)
    if "save" in order:
        save_file(order["save"], order["count"], first)


main()
