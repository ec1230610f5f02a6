"""Writes scenes/gallery/spot.rib with rays of occlusion in place of its ambient light, which all of it is in the way
of, to standard output. From the project's folder:

    python3 tests/bench/spot_occlusion.py > occlusion.rib
    trapeze render occlusion.rib -o occlusion.exr --stats occlusion.json
    trapeze render scenes/gallery/spot.rib -o spot.exr --stats spot.json
"""
import pathlib
import sys

SAMPLES = 64  # rays a point
AMBIENT = 'LightSource "ambientlight" 1 '
SEEN = 'Attribute "visibility" "int diffuse" 1 "int specular" 1 "int transmission" 1\n'

scene = pathlib.Path('scenes/gallery/spot.rib').read_text()
if scene.count(AMBIENT) != 1 or scene.count('WorldBegin\n') != 1:
    sys.exit('spot.rib is not what this script knows: it has no ambient light of its own')
scene = scene.replace('WorldBegin\n', 'WorldBegin\n' + SEEN)
print(scene.replace(AMBIENT, f'LightSource "occlusionlight" 1 "samples" [{SAMPLES}] '), end='')
