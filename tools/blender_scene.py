# SPDX-License-Identifier: Apache-2.0
"""blender -b --factory-startup --python-exit-code 1 -P tools/blender_scene.py -- MESH.ply -o DIR
           [--materials leather|porcelain] [--light NAME] [--relight NAME,...] [--size N] [--samples N]

Renders a capture of several materials with ground truth by Cycles, to see how the program does on an object that it was not made
with. MESH.ply: a closed surface inside the unit ball at the origin, z up. NAME: one of the lights that Blender brings along
(studiolights/world: city, courtyard, forest, interior, night, studio, sunrise, sunset). Layout of the NeRF synthetic scenes, with
true maps in gt/albedo, gt/roughness, gt/metalness and gt/normal, and the test views under other lights in edits/relight/NAME. Takes
ten minutes on two cores.
"""
import argparse
import glob
import json
import math
import os
import sys

import bpy
import numpy
from mathutils import Matrix, Vector

TRAIN, TEST, FIELD_OF_VIEW = 80, 20, 0.6
METAL, DIELECTRIC = 1.0, 0.0


def read_arguments():
    own = sys.argv[sys.argv.index('--') + 1:] if '--' in sys.argv else []
    parser = argparse.ArgumentParser(prog='blender_scene.py', description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('mesh')
    parser.add_argument('-o', '--output', required=True)
    parser.add_argument('--materials', choices=['leather', 'porcelain'], default='porcelain')
    parser.add_argument('--light', default='forest')
    parser.add_argument('--relight', default='city,night')
    parser.add_argument('--size', type=int, default=256)
    parser.add_argument('--samples', type=int, default=64)
    return parser.parse_args(own)


def start_scene(args):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = 'CYCLES'
    scene.render.resolution_x = scene.render.resolution_y = args.size
    scene.render.film_transparent = True
    scene.render.image_settings.file_format, scene.render.image_settings.color_mode = 'PNG', 'RGBA'
    scene.view_settings.view_transform = 'Standard'
    scene.cycles.use_denoising = False
    scene.cycles.max_bounces, scene.cycles.diffuse_bounces, scene.cycles.glossy_bounces = 3, 2, 2
    scene.cycles.sample_clamp_indirect = 8
    bpy.ops.import_mesh.ply(filepath=args.mesh)
    thing = bpy.context.selected_objects[0]
    for face in thing.data.polygons:
        face.use_smooth = True
    return scene, thing


class Nodes:
    """Short forms of the shader nodes that the materials are made of. Values are sockets, numbers or colors."""

    def __init__(self, tree):
        self.nodes, self.links = tree.nodes, tree.links
        self.nodes.clear()
        self.place = self.nodes.new('ShaderNodeTexCoord').outputs['Object']
        split = self.nodes.new('ShaderNodeSeparateXYZ')
        self.links.new(self.place, split.inputs[0])
        self.x, self.y, self.z = split.outputs

    def put(self, value, socket):
        if isinstance(value, (int, float)) and hasattr(socket.default_value, '__len__'):
            socket.default_value = (value, value, value, 1)
        elif isinstance(value, tuple):
            socket.default_value = (*value, 1)
        elif isinstance(value, (int, float)):
            socket.default_value = value
        else:
            self.links.new(value, socket)

    def math(self, operation, *values):
        node = self.nodes.new('ShaderNodeMath')
        node.operation = operation
        for value, socket in zip(values, node.inputs):
            self.put(value, socket)
        return node.outputs[0]

    def mix(self, share, a, b):
        node = self.nodes.new('ShaderNodeMixRGB')
        for value, socket in zip((share, a, b), node.inputs):
            self.put(value, socket)
        return node.outputs[0]

    def noise(self, scale, low, high, detail=3):
        """A random pattern, 0 below `low`, 1 above `high`."""
        node = self.nodes.new('ShaderNodeTexNoise')
        self.put(self.place, node.inputs['Vector'])
        node.inputs['Scale'].default_value, node.inputs['Detail'].default_value = scale, detail
        return self.step(node.outputs['Fac'], low, high)

    def step(self, value, low, high):
        node = self.nodes.new('ShaderNodeMapRange')
        for v, socket in zip((value, low, high), node.inputs):
            self.put(v, socket)
        node.clamp = True
        return node.outputs[0]

    def above(self, value, limit):
        return self.math('GREATER_THAN', value, limit)

    def below(self, value, limit):
        return self.math('LESS_THAN', value, limit)


class Surface:
    """Color, roughness and metalness, material over material."""

    def __init__(self, nodes, color, roughness, metalness):
        self.nodes, self.color, self.roughness, self.metalness = nodes, color, roughness, metalness

    def cover(self, where, color, roughness, metalness):
        self.color = self.nodes.mix(where, self.color, color)
        self.roughness = self.nodes.mix(where, self.roughness, roughness)
        self.metalness = self.nodes.mix(where, self.metalness, metalness)


def leather(n):
    """Leather with steel feet, a golden belt and painted rings, with dull patches."""
    hide = n.mix(n.noise(9, .4, .6), (.22, .085, .04), (.33, .15, .07))
    s = Surface(n, hide, n.mix(n.noise(5, .45, .6), .42, .6), DIELECTRIC)
    rings = n.mix(n.above(n.math('SINE', n.math('MULTIPLY', n.x, 22)), .2), (.08, .3, .33), (.62, .55, .42))
    s.cover(n.above(n.z, .12), rings, .18, DIELECTRIC)
    s.cover(n.math('MULTIPLY', n.above(n.z, 0.), n.below(n.z, .12)), (.95, .68, .3), .25, METAL)
    s.cover(n.below(n.z, -.42), (.56, .57, .58), n.mix(n.noise(6, .48, .56), .2, .42), METAL)
    return s


def porcelain(n):
    """White porcelain with blue figures, a wedge of copper, rubber feet and brushed golden spots."""
    s = Surface(n, n.mix(n.noise(4, .52, .54), (.72, .7, .66), (.04, .07, .3)), .12, DIELECTRIC)
    s.cover(n.above(n.math('ADD', n.x, n.y), .35), (.93, .55, .42), .3, METAL)
    s.cover(n.below(n.z, -.3), (.09, .1, .08), .7, DIELECTRIC)
    s.cover(n.math('MULTIPLY', n.noise(3, .6, .602, 0), n.above(n.z, -.3)), (.98, .8, .45), .4, METAL)
    return s


class Light:
    """The surroundings. Lights get one mean brightness, and no pixel of more than 40 times the mean."""

    def __init__(self, scene, output):
        scene.world = bpy.data.worlds.new('light')
        scene.world.use_nodes = True
        tree = scene.world.node_tree
        self.image = tree.nodes.new('ShaderNodeTexEnvironment')
        tree.links.new(self.image.outputs[0], tree.nodes['Background'].inputs[0])
        self.output = output

    def use(self, name):
        found = [f for folder in ('/usr/share/blender', os.path.dirname(bpy.app.binary_path))
                 for f in glob.glob(f'{folder}/**/studiolights/world/{name}.exr', recursive=True)]
        if not found:
            sys.exit(f'Blender has no light called {name}')
        image = bpy.data.images.load(found[0])
        width, height = image.size
        pixels = numpy.array(image.pixels[:], numpy.float32).reshape(height, width, 4)[..., :3]
        step = max(1, width // 512)
        pixels = pixels[:height // step * step, :width // step * step]
        pixels = pixels.reshape(height // step, step, width // step, step, 3).mean((1, 3))
        brightness = pixels.mean(2)
        pixels *= numpy.minimum(1, 40 * brightness.mean() / numpy.maximum(brightness, 1e-6))[..., None]
        pixels *= .75 / pixels.mean()
        self.image.image = self.stored(name, pixels)

    def stored(self, name, pixels):
        height, width = pixels.shape[:2]
        path = f'{self.output}/envs/{name}.hdr'
        image = bpy.data.images.new(name, width, height, float_buffer=True)
        image.colorspace_settings.name = 'Linear'
        image.pixels = numpy.concatenate([pixels, numpy.ones((height, width, 1), numpy.float32)], 2).ravel()
        image.file_format, image.filepath_raw = 'HDR', path
        image.save()
        return bpy.data.images.load(path)


def camera_poses(count, test):
    """Training views on a spiral over the ball, test views on another."""
    random = numpy.random.default_rng(7)
    for i in range(count):
        if test:
            z, turn, distance = .9 - (i + .5) / count * 1.3, i / count * 5 * 2 * math.pi, 3.4
        else:
            z = .97 - (i + .5) / count * 1.5
            turn = i * math.pi * (3 - math.sqrt(5)) + random.uniform(-.05, .05)
            distance = 3.5 * (1 + random.uniform(-.04, .04))
        around = math.sqrt(1 - z * z)
        at = Vector((around * math.cos(turn), around * math.sin(turn), z)) * distance
        towards = Vector(random.normal(0, .008, 3)) - at
        yield Matrix.Translation(at) @ towards.to_track_quat('-Z', 'Y').to_matrix().to_4x4()


class Photographer:
    def __init__(self, scene, args):
        self.scene, self.args = scene, args
        lens = bpy.data.cameras.new('camera')
        lens.sensor_width, lens.lens = 36, 18 / math.tan(FIELD_OF_VIEW / 2)
        scene.camera = bpy.data.objects.new('camera', lens)
        scene.collection.objects.link(scene.camera)

    def take(self, folder, poses, samples, every=1):
        for i, pose in list(enumerate(poses))[::every]:
            self.scene.camera.matrix_world = pose
            self.scene.cycles.samples, self.scene.cycles.seed = samples, i
            self.scene.render.filepath = f'{self.args.output}/{folder}/r_{i:03d}.png'
            bpy.ops.render.render(write_still=True)

    def describe(self, split, poses):
        size = self.args.size
        focal = .5 * size / math.tan(FIELD_OF_VIEW / 2)
        frames = [{'file_path': f'./{split}/r_{i:03d}', 'transform_matrix': [list(row) for row in pose]}
                  for i, pose in enumerate(poses)]
        with open(f'{self.args.output}/transforms_{split}.json', 'w') as file:
            json.dump({'camera_angle_x': FIELD_OF_VIEW, 'w': size, 'h': size, 'fl_x': focal, 'fl_y': focal, 'cx': size / 2,
                       'cy': size / 2, 'frames': frames}, file, indent=1)


def main():
    args = read_arguments()
    scene, thing = start_scene(args)
    os.makedirs(f'{args.output}/envs', exist_ok=True)
    material = bpy.data.materials.new('material')
    material.use_nodes = True
    n = Nodes(material.node_tree)
    surface = {'leather': leather, 'porcelain': porcelain}[args.materials](n)
    shader, output = n.nodes.new('ShaderNodeBsdfPrincipled'), n.nodes.new('ShaderNodeOutputMaterial')
    for name in ('Specular', 'Specular IOR Level'):  # before and since Blender 4
        if name in shader.inputs:
            shader.inputs[name].default_value = .5
    maps = {'albedo': surface.color, 'roughness': surface.roughness, 'metalness': surface.metalness}
    for value, name in zip(maps.values(), ('Base Color', 'Roughness', 'Metallic')):
        n.put(value, shader.inputs[name])
    n.links.new(shader.outputs[0], output.inputs[0])
    thing.data.materials.clear()
    thing.data.materials.append(material)

    light, photographer = Light(scene, args.output), Photographer(scene, args)
    train, test = list(camera_poses(TRAIN, False)), list(camera_poses(TEST, True))
    light.use(args.light)
    for split, poses, samples in (('train', train, args.samples), ('test', test, 2 * args.samples)):
        photographer.take(split, poses, samples)
        photographer.describe(split, poses)
    for name in args.relight.split(','):
        light.use(name)
        photographer.take(f'edits/relight/{name}', test, 2 * args.samples, every=2)

    glow = n.nodes.new('ShaderNodeEmission')  # what a map says, without light
    n.links.new(glow.outputs[0], output.inputs[0])
    for name, value in maps.items():
        n.put(value, glow.inputs[0])
        scene.view_settings.view_transform = 'Standard' if name == 'albedo' else 'Raw'
        photographer.take(f'gt/{name}', test, 24)
    encoded = n.nodes.new('ShaderNodeVectorMath')
    encoded.operation = 'MULTIPLY_ADD'
    n.links.new(n.nodes.new('ShaderNodeNewGeometry').outputs['Normal'], encoded.inputs[0])
    encoded.inputs[1].default_value = encoded.inputs[2].default_value = (.5, .5, .5)
    n.links.new(encoded.outputs[0], glow.inputs[0])
    scene.render.image_settings.color_depth = '16'
    photographer.take('gt/normal', test, 24)


main()
