#include "mesh/gmsh_library.hpp"

#ifdef DRIFTWRIGHT_ON_DEMAND

#include <dlfcn.h>
#include <fmt/format.h>

#include <mutex>

#include "base/errors.hpp"

extern "C" {
extern const char driftwright_gmsh_file[];
extern const char* const driftwright_gmsh_symbols[];
extern void* driftwright_gmsh_addresses[];
}

namespace driftwright::mesh {

namespace {

void require_loaded(const void* found) {
  if (found == nullptr)
    throw SolveError(fmt::format("Gmsh, which makes and reads meshes, cannot be loaded: {}; install the package of {}",
                                 dlerror(), driftwright_gmsh_file));
}

}  // namespace

void load_gmsh() {
  static std::once_flag loaded;
  std::call_once(loaded, [] {
    void* library = dlopen(driftwright_gmsh_file, RTLD_LAZY | RTLD_LOCAL);
    require_loaded(library);
    for (std::size_t i = 0; driftwright_gmsh_symbols[i] != nullptr; ++i) {
      driftwright_gmsh_addresses[i] = dlsym(library, driftwright_gmsh_symbols[i]);
      require_loaded(driftwright_gmsh_addresses[i]);
    }
  });
}

}  // namespace driftwright::mesh

#else

void driftwright::mesh::load_gmsh() {}

#endif
