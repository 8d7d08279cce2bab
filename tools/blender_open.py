# SPDX-License-Identifier: Apache-2.0
"""blender [-b] --factory-startup --python-exit-code 1 -P tools/blender_open.py -- OBJECT.glb [LIGHT.hdr]
           [--cameras render.json -o DIR] [--view NAME] [--samples N]

Opens an asset that `cei3d export PROJECT -o OBJECT.glb --light fit` wrote, and its light as the world, turned as it was
around the object; for the colors of the photographs the view transform becomes "Standard". With --cameras, renders the
object by Cycles from every camera of a file that `cei3d render` wrote (--view: from that one) to DIR/NAME.png. For Blender
3.4 to 4.x.
"""
import argparse
import json
import os
import sys

import bpy
import numpy
from mathutils import Matrix, Vector

# The glTF importer of Blender 3.4 uses a name that NumPy 1.24, which Debian 12 has, no longer knows.
if not hasattr(numpy, 'bool'):
    numpy.bool = bool

# Importing glTF turns y-up into Blender's z-up.
BLENDER_FROM_GLTF = Matrix(((1, 0, 0), (0, 0, -1), (0, 1, 0)))
# From the capture's directions to those of Blender's own maps, by the axis that is up in the exported map: its center
# looks along Blender's +X, a quarter of its width along +Y.
MAP_FROM_CAPTURE = {'z': Matrix.Identity(3), 'y': Matrix(((0, 0, 1), (1, 0, 0), (0, 1, 0)))}


def read_arguments():
    own = sys.argv[sys.argv.index('--') + 1:] if '--' in sys.argv else []
    parser = argparse.ArgumentParser(prog='blender_open.py', description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('object')
    parser.add_argument('light', nargs='?')
    parser.add_argument('--cameras')
    parser.add_argument('-o', '--output')
    parser.add_argument('--view')
    parser.add_argument('--samples', type=int, default=128)
    args = parser.parse_args(own)
    if bool(args.cameras) != bool(args.output):
        parser.error('--cameras and --output go together')
    for path in filter(None, (args.object, args.light, args.cameras)):
        if not os.path.exists(path):
            parser.error(f'{path} does not exist')
    return args


def open_object(path):
    """The transform from the capture's frame to Blender's world."""
    bpy.ops.object.select_all(action='SELECT')
    bpy.ops.object.delete()
    bpy.ops.import_scene.gltf(filepath=path)
    meshes = [o for o in bpy.context.scene.objects if o.type == 'MESH']
    if not meshes:
        sys.exit(f'{path} holds no mesh')
    bpy.context.view_layer.update()
    return meshes[0].matrix_world @ BLENDER_FROM_GLTF.to_4x4()


def set_light(path, world_from_capture):
    turn = world_from_capture.to_quaternion().to_matrix()
    up = turn.transposed() @ Vector((0, 0, 1))
    from_world = MAP_FROM_CAPTURE['y' if abs(up.y) > 0.9 else 'z'] @ turn.transposed()
    world = bpy.data.worlds.new('light')
    bpy.context.scene.world = world
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    coordinates, mapping, picture = (nodes.new(f'ShaderNode{n}') for n in ('TexCoord', 'Mapping', 'TexEnvironment'))
    mapping.vector_type = 'POINT'
    mapping.inputs['Rotation'].default_value = from_world.to_euler('XYZ')
    picture.image = bpy.data.images.load(os.path.abspath(path))
    links.new(coordinates.outputs['Generated'], mapping.inputs['Vector'])
    links.new(mapping.outputs['Vector'], picture.inputs['Vector'])
    links.new(picture.outputs['Color'], nodes['Background'].inputs['Color'])


def set_colors(scene):
    scene.view_settings.view_transform = 'Standard'
    scene.view_settings.look = 'None'
    scene.view_settings.exposure = 0
    scene.view_settings.gamma = 1


def set_cycles(scene, samples):
    scene.render.engine = 'CYCLES'
    scene.render.film_transparent = True
    scene.render.dither_intensity = 0
    scene.render.image_settings.file_format = 'PNG'
    scene.render.image_settings.color_mode = 'RGBA'
    scene.cycles.samples = samples
    scene.cycles.use_denoising = False
    scene.cycles.sample_clamp_direct = scene.cycles.sample_clamp_indirect = 0


def place_camera(scene, camera, world_from_capture):
    """camera: of render.json; axes of OpenCV."""
    data = bpy.data.cameras.new('camera')
    data.sensor_fit = 'HORIZONTAL'
    data.sensor_width = 36
    data.lens = camera['fx'] * data.sensor_width / camera['width']
    data.shift_x = 0.5 - camera['cx'] / camera['width']
    data.shift_y = (camera['cy'] - camera['height'] / 2) / camera['width']
    center = world_from_capture @ Vector(camera['center'])
    turn = world_from_capture.to_quaternion().to_matrix() @ Matrix(camera['world_from_cam']) @ Matrix.Diagonal((1, -1, -1))
    distance = center.length
    data.clip_start, data.clip_end = distance / 1000, distance * 10
    thing = bpy.data.objects.new('camera', data)
    thing.matrix_world = Matrix.Translation(center) @ turn.to_4x4()
    scene.collection.objects.link(thing)
    scene.camera = thing
    scene.render.resolution_x, scene.render.resolution_y = camera['width'], camera['height']
    scene.render.resolution_percentage = 100


def main():
    args = read_arguments()
    scene = bpy.context.scene
    world_from_capture = open_object(args.object)
    if args.light:
        set_light(args.light, world_from_capture)
    set_colors(scene)
    set_cycles(scene, args.samples)
    if not args.cameras:
        return
    cameras = [c for c in json.load(open(args.cameras))['cameras'] if args.view in (None, c['name'])]
    if not cameras:
        sys.exit(f'{args.cameras} has no camera {args.view}')
    for camera in cameras:
        place_camera(scene, camera, world_from_capture)
        scene.render.filepath = os.path.abspath(os.path.join(args.output, camera['file']))
        bpy.ops.render.render(write_still=True)


if __name__ == '__main__':
    main()
