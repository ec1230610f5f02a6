"""Writes a scene to standard output whose rays meet far more than its picture shows: 120 moving balls on a floor under
ambient occlusion, 16 rays a point. Of 12.6 million micropolygons for rays with two positions each, 437 MB.

    python3 tests/bench/moving_balls.py > balls.rib
    trapeze render balls.rib --memory 20M --stats s.json
"""
import random

random.seed(7)
print('''Option "trace" "int levels" 4
Display "balls.exr" "openexr" "rgba" Format 640 360 1 PixelSamples 2 2 PixelFilter "gaussian" 2 2
Shutter 0 1 Projection "perspective" "fov" 40 Translate 0 -.6 3
WorldBegin
Attribute "visibility" "int diffuse" 1
Attribute "trace" "int samplemotion" 1
LightSource "occlusionlight" 1 "samples" [16]
Surface "matte" "Ka" 1
Polygon "P" [-20 0 -4 20 0 -4 20 0 40 -20 0 40]''')
for ball in range(120):
    radius = random.uniform(.15, .5)
    color = ' '.join(f'{random.uniform(.3, 1):.2f}' for channel in range(3))
    x, z = random.uniform(-3, 3), random.uniform(-2, 9)
    print(f'AttributeBegin Color {color} MotionBegin [0 1] Translate {x:.3f} {radius:.3f} {z:.3f} '
          f'Translate {x + .15:.3f} {radius:.3f} {z:.3f} MotionEnd '
          f'Sphere {radius:.3f} {-radius:.3f} {radius:.3f} 360 AttributeEnd')
print('WorldEnd')
