/// Instances share what they dice alike: grids in object space, and the points that measure edges. The same
/// shape elsewhere under the camera that is diced at the same rates there (at much the same distance, or
/// everywhere with an orthographic camera) has the same points, and takes them from its neighbour; what the
/// camera changes, and shading, is each instance's own.
#pragma once

#include <atomic>
#include <memory>

#include "tessellate/topology/surface.h"

namespace trapeze {

/// The memory, in bytes, that several surfaces' shared grids may take together; when it is full, no more are
/// kept, and nothing else changes. It only ever shrinks: nothing is dropped to make room, for whatever fills
/// it first is as likely to be wanted again.
struct SharedGridBudget {
    std::atomic<size_t> bytes_left{0};
};

/// A surface that gives what another one does and remembers what it evaluates. May be used by many threads at
/// once; the budget outlives it. Results are the other surface's own, bit for bit.
std::unique_ptr<Surface> share_grids(std::shared_ptr<const Surface> surface, SharedGridBudget& budget);

/// Whether the shape's points take so long to find that remembering them pays: subdivision surfaces and
/// NURBS.
bool pays_to_share(const Topology& topology);

}  // namespace trapeze
