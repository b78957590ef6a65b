#pragma once

namespace driftwright {

/// File formats for whole fields at many times.
enum class FieldsFormat {
  kVtu,   ///< one compressed .vtu per time, each with the mesh, and fields.pvd
  kXdmf,  ///< one fields.h5 with the mesh once, and fields.xdmf
  kNone,  ///< no fields
};

}  // namespace driftwright
