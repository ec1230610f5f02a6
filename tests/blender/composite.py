"""What Blender's compositor makes of a file's layers and names, for tests/blender/run: FILE NAME..."""
import pathlib
import sys

import bpy

file, names = sys.argv[sys.argv.index("--") + 1], sys.argv[sys.argv.index("--") + 2:]
image = bpy.data.images.load(str(pathlib.Path(file).resolve()))
scene = bpy.context.scene
for thing in list(bpy.data.objects):
    if thing.type != "CAMERA":
        bpy.data.objects.remove(thing)
scene.render.engine = "CYCLES"
scene.cycles.samples = 1
scene.render.resolution_x, scene.render.resolution_y = image.size[0] or 320, image.size[1] or 240
scene.render.resolution_percentage = 100
scene.view_settings.view_transform = "Raw"
scene.use_nodes = True
nodes, links = scene.node_tree.nodes, scene.node_tree.links
nodes.clear()

layers = nodes.new("CompositorNodeImage")
layers.image = image
print("layers:", [output.name for output in layers.outputs if output.enabled])


def write(name, socket):
    """A file of a socket's values, unchanged."""
    output = nodes.new("CompositorNodeOutputFile")
    output.base_path = str(pathlib.Path.cwd())
    output.format.file_format = "OPEN_EXR"
    output.format.color_depth = "32"
    output.file_slots[0].path = name + "-####"
    links.new(socket, output.inputs[0])


for layer in ("Combined", "albedo", "N"):
    write("shown-" + layer, layers.outputs[layer])
for name in names:
    matte = nodes.new("CompositorNodeCryptomatteV2")
    matte.source = "IMAGE"
    matte.image = image
    matte.matte_id = name
    write("matte-" + name, matte.outputs["Matte"])
nodes.new("CompositorNodeComposite")
bpy.ops.render.render()
for made in pathlib.Path.cwd().glob("*-0001.exr"):
    made.rename(made.name.replace("-0001", ""))
