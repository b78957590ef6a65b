#pragma once
// Gmsh is loaded when it is first needed (cmake/on_demand.cmake): most commands never draw or read a mesh.

namespace driftwright::mesh {

/// Loads Gmsh, once for the process; afterwards its functions may be called. A GmshSession does so itself.
/// @throws SolveError  if the library is not there or lacks a function
void load_gmsh();

}  // namespace driftwright::mesh
