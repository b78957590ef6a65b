#pragma once
// A reduced machine or an observer as plain C99 for a PLC: no memory taken at run time, sizes fixed, libm alone.

#include "output/fmu/fmu_file.hpp"

namespace driftwright::output {

/// The files of a folder that compiles as it is: plain_model.h (sizes, names, what to call), the sources of a unit without
/// its interfaces, model_data.c, an example, and the reference run of the order. A machine gives predict()'s drift exactly
/// over any step where no law follows temperatures; an observer takes a sample every period of its rows.
/// @param order  version and interfaces are not used
[[nodiscard]] std::vector<FmuEntry> plain_c_files(const FmuOrder& order, const Provenance& made_by);

}  // namespace driftwright::output
