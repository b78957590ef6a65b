#pragma once
// What an input file of Abaqus or CalculiX lists of its mesh, with the file's numbers, before anything is looked up: blocks
// may come in any order.

#include <Eigen/Core>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace driftwright::mesh {

/// Names are in lower case.
struct InpDeck {
  /// A 3-D element, or a 2-D one of which the corners are kept.
  struct Element {
    long number;
    std::optional<CellShape> shape;  ///< none: 2-D
    int n_nodes, line;
    int set;  ///< of its *ELEMENT line, index into set_names
  };
  /// Numbers of a set as a line lists them: first, first + step ... up to last. A number that is listed alone must exist; a
  /// range skips those that do not, as solvers do.
  struct Listed {
    long first, last, step;
    int line;
  };
  struct Set {
    std::vector<Listed> numbers;
    std::set<std::string> sets;  ///< others that it holds
  };
  using Sets = std::map<std::string, Set>;
  struct SurfaceLine {
    std::string name, type;
    std::optional<long> number;  ///< of an element or node; none: a set
    std::string set, face;       ///< face: "s1" ..., "spos", "" for all free ones
    int line;
  };

  std::string path;
  std::map<long, int> node;               ///< index of each node by its number
  std::vector<Eigen::Vector3d> position;  ///< of each node, in the file's unit of length, Cartesian
  std::vector<long> node_number;          ///< of each node
  std::vector<Element> elements;
  std::vector<long> element_nodes;     ///< node numbers of all elements, one after the other
  std::vector<std::string> set_names;  ///< "" for lines without ELSET
  std::set<long> left_out;             ///< numbers of elements that are not 3-D
  Sets node_sets, element_sets;
  std::vector<std::string> section_sets;  ///< the ELSETs of *SOLID SECTION lines
  std::vector<SurfaceLine> surface_lines;
};

/// @throws InputError  with file and line: a number that cannot be read, a set or node that is defined wrongly, a 3-D
///                     element that is not computed with, a keyword that makes nodes or elements (*NGEN, *INCLUDE, *INSTANCE
///                     with a shift ...)
[[nodiscard]] InpDeck read_inp_deck(const std::string& path);

/// @throws InputError  file:line: message
[[noreturn]] void fail_in(const InpDeck& deck, int line, const std::string& message);

}  // namespace driftwright::mesh
