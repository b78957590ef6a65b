#pragma once
// Fields as XDMF: numbers in one HDF5 file, with the mesh once, and an XML file that describes them.

#include <memory>

#include "mesh/mesh.hpp"
#include "output/field_series.hpp"

namespace driftwright::output {

/// Writes fields as fields.h5 and fields.xdmf. Callers use FieldSeries.
///
/// fields.h5: mesh/coordinates (n_nodes x 3 [m]), mesh/cells (XDMF topology), mesh/region (one index a cell), and for each
/// time times/<0000...>/ temperature_degC, displacement_um, with stresses stress_MPa and von_mises_MPa.
/// fields.xdmf: a temporal collection of grids with their time [s]; `made_by` and `region_names` (one a line, in the order
/// of the index) as Information. Cells of one shape are an array n_cells x n_nodes_of(shape), cells of several an XDMF
/// topology "Mixed": number of the shape, then its nodes. XDMF orders the nodes of all six shapes as VTK does, and so do we.
/// Stresses are a "Matrix" of 6 columns in VTK's order and not a "Tensor6": ParaView's XDMF 2 reader takes that as xx, xy,
/// xz, yy, yz, zz, its XDMF 3 readers as xx, yy, zz, xy, yz, xz.
/// Source: XDMF Model and Format, https://www.xdmf.org/index.php/XDMF_Model_and_Format
/// @param mesh  at least one cell
[[nodiscard]] std::unique_ptr<FieldWriter> make_xdmf_writer(ResultsFolder& folder, const mesh::Mesh& mesh);

}  // namespace driftwright::output
