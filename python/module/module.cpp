// The compiled part of the Python package: tailwater._simulation.
#include <pybind11/functional.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <exception>
#include <optional>

#include "case/reader.h"
#include "io/messages.h"
#include "linear/session.h"
#include "python_simulation.h"
#include "results/provenance.h"
#include "run/run_case.h"
#include "small_matrix.h"

namespace py = pybind11;

namespace tailwater {
namespace {

std::optional<LinearSession> session;
std::optional<Communicator> ranks;

void end_session() {
  ranks.reset();
  session.reset();
}

/// Whether this process was not started with others is for MPI to say.
Communicator find_ranks() {
  int size = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return size > 1 ? Communicator::world() : Communicator();
}

void raise(const char* kind, const UserError& error) {
  const py::object type = py::module_::import("tailwater.errors").attr(kind);
  PyErr_SetObject(type.ptr(), type(error.what()).ptr());
}

void translate_errors(std::exception_ptr pointer) {
  try {
    if (pointer) std::rethrow_exception(pointer);
  } catch (const InputError& error) {
    raise("InputError", error);
  } catch (const SolverError& error) {
    raise("SolverError", error);
  } catch (const IoError& error) {
    raise("IoError", error);
  }
}

template <int Dim>
py::object make_simulation(CaseSpec spec, std::optional<RunOptions> options) {
  return with_places(spec, [&] { return py::cast(std::make_unique<PythonSimulation<Dim>>(spec, std::move(options))); });
}

py::object open_simulation(const std::string& file, const std::vector<std::string>& overrides,
                           const std::optional<std::string>& out, bool force) {
  const Communicator& all = ranks_of_process();
  begin_messages(all.is_root() ? Voice::quiet : Voice::silent);
  CaseSpec spec = read_case(file, overrides);
  std::optional<RunOptions> options;
  if (out) options = RunOptions{.case_file = file, .out = *out, .force = force, .wall_time = {}};
  return spec.general.dimension == 2 ? make_simulation<2>(std::move(spec), std::move(options))
                                     : make_simulation<3>(std::move(spec), std::move(options));
}

template <int Dim>
void bind_simulation(py::module_& module, const char* name) {
  using Flown = PythonSimulation<Dim>;
  const auto of_state = [](auto get) { return [get](const Flown& self) { return get(self.state()); }; };
  const auto of_body = [](auto get) { return [get](const Flown& self, std::size_t b) { return get(self.body(b)); }; };
  py::class_<Flown>(module, name)
      .def("start", &Flown::start)
      .def("prepare", &Flown::prepare)
      .def("step", &Flown::step)
      .def("finish", &Flown::finish)
      .def_property_readonly("dimension", [](const Flown&) { return Dim; })
      .def_property_readonly("end", [](const Flown& self) { return self.spec().time.end; })
      .def_property_readonly("spacing", [](const Flown& self) { return self.spec().particles.spacing; })
      .def_property_readonly("density", [](const Flown& self) { return self.spec().physics.density; })
      .def_property_readonly("time", of_state([](const State<Dim>& state) { return state.time; }))
      .def_property_readonly("number", of_state([](const State<Dim>& state) { return state.step; }))
      .def_property_readonly("dt", &Flown::dt)
      .def_property_readonly("iterations", [](const Flown& self) { return self.report().iterations; })
      .def_property_readonly("position", &Flown::position)
      .def_property_readonly("velocity", &Flown::velocity)
      .def_property_readonly("pressure", &Flown::pressure)
      .def_property_readonly("volume", &Flown::volume)
      .def_property_readonly("id", &Flown::id)
      .def_property_readonly("kind", &Flown::kind)
      .def_property_readonly("acceleration", &Flown::acceleration)
      .def("set_discharge", &Flown::set_discharge)
      .def("steer", &Flown::steer)
      .def_property_readonly("bodies",
                             [](const Flown& self) {
                               std::vector<std::string> names;
                               for (const FloatingBody<Dim>& body : self.bodies()) names.push_back(body.name);
                               return names;
                             })
      .def("body_centre", of_body([](const BodyState<Dim>& body) { return body.centre; }))
      .def("body_velocity", of_body([](const BodyState<Dim>& body) { return body.velocity; }))
      .def("body_turn", of_body([](const BodyState<Dim>& body) { return body.placement.linear; }))
      .def("body_shift", of_body([](const BodyState<Dim>& body) { return body.placement.constant; }))
      .def("push", &Flown::push);
}

}  // namespace

const Communicator& ranks_of_process() {
  if (!session) session.emplace();
  if (!ranks) ranks = find_ranks();
  return *ranks;
}

}  // namespace tailwater

PYBIND11_MODULE(_simulation, module) {
  using namespace tailwater;
  py::register_exception_translator(&translate_errors);
  bind_simulation<2>(module, "Simulation2");
  bind_simulation<3>(module, "Simulation3");
  module.def("open", &open_simulation);
  module.def("warnings", &warnings);
  module.def("version", &version_line);
  module.def("rank", [] { return ranks_of_process().rank(); });
  module.def("ranks", [] { return ranks_of_process().size(); });
  module.def("abort", [] { MPI_Abort(MPI_COMM_WORLD, 1); });
  module.def("end_session", &end_session);
}
