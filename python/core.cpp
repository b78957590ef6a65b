// The module driftwright.core: the library's API, unchanged. driftwright/__init__.py converts its records to pandas tables.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "driftwright/driftwright.hpp"

namespace py = pybind11;
using namespace driftwright;

namespace {

/// A copy in NumPy's own memory.
template <class T>
py::array_t<T> array(const std::vector<T>& values) {
  return py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data());
}
py::array_t<double> vectors(const std::vector<double>& values) {
  return py::array_t<double>({static_cast<py::ssize_t>(values.size() / 3), py::ssize_t{3}}, values.data());
}

using Columns = std::vector<std::tuple<std::string, std::string, py::array_t<double>>>;

/// (source, times in s, [(channel, unit, values)]).
py::tuple columns_of(const Record& record) {
  Columns columns;
  for (const Channel& channel : record.channels) columns.emplace_back(channel.name, channel.unit, array(channel.values));
  return py::make_tuple(record.source, array(record.time_s), columns);
}

Record record_of(const std::string& source, const std::vector<double>& time_s,
                 const std::vector<std::tuple<std::string, std::string, std::vector<double>>>& columns) {
  Record record{.source = source, .time_s = time_s, .channels = {}};
  for (const auto& [name, unit, values] : columns) {
    if (values.size() != time_s.size()) throw InputError("channel " + name + " has another number of rows than the times");
    record.channels.push_back({name, unit, values});
  }
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    if (!(time_s[i] > time_s[i - 1])) throw InputError(source + ": time must increase from row to row");
  }
  return record;
}

/// A listener that calls a Python function with the current work.
Listener listener_of(const py::object& progress) {
  if (progress.is_none()) return {};
  const auto function = std::make_shared<py::object>(progress);
  return {.on_begin =
              [function](const std::string& work) {
                const py::gil_scoped_acquire gil;
                (*function)(work);
              },
          .on_share = {},
          .wants_end_now = {}};
}

using Unlocked = py::call_guard<py::gil_scoped_release>;

void add_errors(py::module_& m) {
  static py::exception<InputError> input_error(m, "InputError", PyExc_ValueError);
  static py::exception<SolveError> solve_error(m, "SolveError", PyExc_ArithmeticError);
  py::register_exception_translator([](std::exception_ptr p) {
    try {
      if (p) std::rethrow_exception(p);
    } catch (const InputError& e) {
      input_error(e.what());
    } catch (const RangeError& e) {
      input_error(e.what());
    } catch (const SolveError& e) {
      solve_error(e.what());
    }
  });
}

void add_records_and_cyclograms(py::module_& m) {
  py::class_<Record>(m, "Record").def(py::init(&record_of)).def_property_readonly("columns", &columns_of);
  m.def("read_record", &read_record_csv, Unlocked());
  m.def("record_csv", &record_csv, Unlocked());
  py::class_<Cyclogram>(m, "Cyclogram")
      .def_readwrite("name", &Cyclogram::name)
      .def_property_readonly("duration_s", &Cyclogram::duration_s);
  m.def("cyclogram_of_speeds",
        [](const std::string& name, const std::vector<double>& duration_s, const std::vector<double>& speed_rpm) {
          if (duration_s.size() != speed_rpm.size()) throw InputError("as many durations as speeds are required");
          Cyclogram cyclogram{.name = name, .sections = {}};
          for (std::size_t i = 0; i < duration_s.size(); ++i) {
            if (!(duration_s[i] > 0.0) || !(speed_rpm[i] >= 0.0))
              throw InputError("durations must be positive, and no speed may be negative");
            cyclogram.sections.push_back({duration_s[i], Drive{.speed_rpm = speed_rpm[i]}});
          }
          return cyclogram;
        });
}

/// Meshes, fields and runs, which machines give.
void add_runs(py::module_& m) {
  py::class_<PredictOptions>(m, "PredictOptions")
      .def(py::init([](std::string start, std::string after_pause, std::string model) {
        return PredictOptions{std::move(start), std::move(after_pause), std::move(model)};
      }));
  py::class_<Mesh>(m, "Mesh")
      .def_property_readonly("points_m", [](const Mesh& mesh) { return vectors(mesh.points_m); })
      .def_property_readonly("offset", [](const Mesh& mesh) { return array(mesh.offset); })
      .def_property_readonly("node", [](const Mesh& mesh) { return array(mesh.node); })
      .def_property_readonly("vtk_type", [](const Mesh& mesh) { return array(mesh.vtk_type); })
      .def_property_readonly("region", [](const Mesh& mesh) { return array(mesh.region); })
      .def_readonly("region_name", &Mesh::region_name);
  py::class_<Field>(m, "Field")
      .def_readonly("time_s", &Field::time_s)
      .def_property_readonly("temperature_degC", [](const Field& field) { return array(field.temperature_degC); })
      .def_property_readonly("displacement_um", [](const Field& field) { return vectors(field.displacement_um); });
  py::class_<Run>(m, "Run")
      .def_property_readonly("headers",
                             [](const Run& run) {
                               std::vector<std::string> headers;
                               for (const Channel& channel : run.channels()) headers.push_back(channel.header());
                               return headers;
                             })
      .def(
          "step",
          [](Run& run, double time_s, double speed_rpm, std::optional<double> ambient_degC, std::array<double, 3> feed_m_s,
             double cutting_power_W) {
            return run.step({.time_s = time_s,
                             .drive = {.speed_rpm = speed_rpm, .feed_m_s = feed_m_s, .cutting_power_W = cutting_power_W},
                             .ambient_degC = ambient_degC});
          },
          Unlocked());
}

void add_diagnosis(py::module_& m) {
  py::class_<Estimate>(m, "Estimate")
      .def_readonly("name", &Estimate::name)
      .def_readonly("unit", &Estimate::unit)
      .def_readonly("value", &Estimate::value)
      .def_readonly("low", &Estimate::low)
      .def_readonly("high", &Estimate::high)
      .def("__repr__",
           [](const Estimate& e) { return e.name + " " + py::str(py::float_(e.value)).cast<std::string>() + " " + e.unit; });
  py::class_<Cause>(m, "Cause")
      .def_readonly("effect", &Cause::effect)
      .def_readonly("where", &Cause::where)
      .def_readonly("law", &Cause::law)
      .def_readonly("standing", &Cause::standing)
      .def_readonly("parameters", &Cause::parameters)
      .def_readonly("log_evidence_gain", &Cause::log_evidence_gain)
      .def_readonly("is_written", &Cause::is_written)
      .def_readonly("why_not_written", &Cause::why_not_written)
      .def_readonly("alternatives", &Cause::alternatives)
      .def("__repr__", [](const Cause& c) { return c.standing + ": " + c.effect + " at " + c.where; });
  py::class_<ChannelGain>(m, "ChannelGain")
      .def_readonly("name", &ChannelGain::name)
      .def_readonly("unit", &ChannelGain::unit)
      .def_readonly("rmse_before", &ChannelGain::rmse_before)
      .def_readonly("rmse_calibrated", &ChannelGain::rmse_calibrated)
      .def_readonly("rmse_after", &ChannelGain::rmse_after)
      .def_readonly("noise_floor", &ChannelGain::noise_floor)
      .def_readonly("rmse_all_before", &ChannelGain::rmse_all_before)
      .def_readonly("rmse_written", &ChannelGain::rmse_written);
  py::class_<Diagnosis>(m, "Diagnosis")
      .def_readonly("verdict", &Diagnosis::verdict)
      .def_readonly("reason", &Diagnosis::reason)
      .def_readonly("causes", &Diagnosis::causes)
      .def_readonly("calibrated", &Diagnosis::calibrated)
      .def_readonly("holdout", &Diagnosis::holdout)
      .def_readonly("gain", &Diagnosis::gain)
      .def_readonly("extended_scenario", &Diagnosis::extended_scenario)
      .def_readonly("not_written", &Diagnosis::not_written);
}

void add_machine(py::module_& m) {
  py::class_<Machine>(m, "Machine")
      .def(py::init(
          [](const std::string& scenario, const py::object& progress) { return Machine(scenario, listener_of(progress)); }))
      .def_property_readonly("name", &Machine::name)
      .def_property_readonly("scenario_file", &Machine::scenario_file)
      .def_property_readonly("cyclograms", &Machine::cyclograms)
      .def_property_readonly("sensors", &Machine::sensors)
      .def_property_readonly("displacements", &Machine::displacements)
      .def_property_readonly("tilts", &Machine::tilts)
      .def("cyclogram", py::overload_cast<const std::string&>(&Machine::cyclogram, py::const_))
      .def("cyclogram_of", py::overload_cast<const Record&>(&Machine::cyclogram, py::const_))
      .def("predict", py::overload_cast<const Cyclogram&, const PredictOptions&>(&Machine::predict, py::const_), Unlocked())
      .def("predict_all",
           py::overload_cast<const std::vector<Cyclogram>&, const PredictOptions&>(&Machine::predict, py::const_),
           Unlocked())
      .def("simulate", &Machine::simulate, Unlocked())
      .def("fields", &Machine::fields, Unlocked())
      .def("mesh", &Machine::mesh, Unlocked())
      .def(
          "start",
          [](const Machine& machine, std::optional<double> ambient_degC, const std::string& name) {
            return machine.start(ambient_degC, name);
          },
          Unlocked())
      .def(
          "diagnose",
          [](const Machine& machine, const std::vector<Record>& measured, std::vector<std::string> without, bool causes_only,
             bool as_recorded) {
            return machine.diagnose(measured,
                                    {.without = std::move(without), .causes_only = causes_only, .as_recorded = as_recorded});
          },
          Unlocked())
      .def("calibrate", &Machine::calibrate, Unlocked());
}

void add_judging(py::module_& m) {
  py::class_<JudgedCase>(m, "JudgedCase")
      .def_readonly("record", &JudgedCase::record)
      .def_readonly("failed", &JudgedCase::failed)
      .def_readonly("rms_before_um", &JudgedCase::rms_before_um)
      .def_readonly("peak_before_um", &JudgedCase::peak_before_um)
      .def_readonly("rms_left_um", &JudgedCase::rms_left_um)
      .def_readonly("peak_left_um", &JudgedCase::peak_left_um);
  py::class_<JudgedStrategy>(m, "JudgedStrategy")
      .def_readonly("name", &JudgedStrategy::name)
      .def_readonly("verdict", &JudgedStrategy::verdict)
      .def_readonly("why", &JudgedStrategy::why)
      .def_readonly("is_baseline", &JudgedStrategy::is_baseline)
      .def_readonly("cases", &JudgedStrategy::cases);
  m.def(
      "judge",
      [](const std::string& scenario, const std::vector<std::string>& train, const std::vector<std::string>& test) {
        return judge(scenario, train, test);
      },
      Unlocked());
}

}  // namespace

PYBIND11_MODULE(core, m) {
  m.doc() = "Driftwright: digital twin of a machine tool's thermal behaviour";
  m.attr("__version__") = version();
  add_errors(m);
  add_records_and_cyclograms(m);
  add_runs(m);
  add_diagnosis(m);
  add_machine(m);
  add_judging(m);
  m.def("command", &command, Unlocked());
}
