/// What the header of an OpenEXR file says of its Cryptomatte layers (Psyop's Cryptomatte specification 1.2).
#pragma once

#include <OpenEXR/ImfHeader.h>

#include <string>

#include "composite/displays/picture_to_write.h"

namespace trapeze {

/// Adds for each layer of the file its name, hash, conversion and manifest, and the filter of all as
/// "cryptomatteFilter"; nothing where there are no layers. A manifest has the names of the whole scene,
/// whatever part of the picture this is.
void add_matte_attributes(const PictureToWrite& picture, Imf::Header& header);

/// The manifest of a layer: a JSON object of names, with their hashes as eight hexadecimal digits. Bytes of a
/// name that are no UTF-8 are replaced, since JSON has no others.
std::string matte_manifest(const Scene& scene, MatteLayer layer, const Diagnostics& sources);

}  // namespace trapeze
