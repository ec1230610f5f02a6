/* A procedural for Procedural "DynamicLoad": a tree of cylinders, each carrying three thinner ones.
 *
 *     cc -shared -fPIC -Ipipeline/ri docs/examples/branches.c -o branches.so -lm
 *     trapeze render --allow-programs SCENE.rib, where the scene has
 *         Procedural "DynamicLoad" ["branches" "5 0.7"] [-1 1 -1 1 0 2]
 *
 * The arguments are the levels of branches and how much shorter each level is than the one before. */
#include <ri.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct {
    int levels;
    float shrink;
} Branch;

static Branch *new_branch(int levels, float shrink) {
    Branch *branch = malloc(sizeof *branch);
    branch->levels = levels;
    branch->shrink = shrink;
    return branch;
}

RtPointer ConvertParameters(RtString arguments) {
    Branch *branch = new_branch(4, 0.7f);
    sscanf(arguments, "%d %f", &branch->levels, &branch->shrink);
    return branch;
}

RtVoid Free(RtPointer data) {
    free(data);
}

RtVoid Subdivide(RtPointer data, RtFloat detail) {
    const Branch *branch = data;
    RtBound bound = {-1, 1, -1, 1, 0, 2};
    RtColor green = {0.2f, 0.6f, 0.2f}, brown = {0.5f, 0.35f, 0.2f};
    int i;
    (void)detail;
    RiColor(branch->levels > 1 ? brown : green);
    RiCylinder(0.06f, 0, 1, 360, RI_NULL);
    if (branch->levels <= 1) return;
    for (i = 0; i < 3; ++i) {
        RiTransformBegin();
        RiTranslate(0, 0, 1);
        RiRotate((RtFloat)(120 * i + 25 * branch->levels), 0, 0, 1);
        RiRotate(38, 0, 1, 0);
        RiScale(branch->shrink, branch->shrink, branch->shrink);
        RiProcedural(new_branch(branch->levels - 1, branch->shrink), bound, Subdivide, Free);
        RiTransformEnd();
    }
}
