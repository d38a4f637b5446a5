// The initial velocity of a block of water, by numbers or expressions of the place.
#pragma once

#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/number_range.h"
#include "case/expression.h"
#include "case/named_numbers.h"
#include "geometry/from_spec.h"
#include "geometry/largest_speed.h"

namespace tailwater {

/// The initial velocity of one block.
template <int Dim>
class StartVelocity {
 public:
  StartVelocity(const CaseSpec& spec, const FluidTable& block, const CaseLabel& owner) : owner_(owner) {
    if (!block.velocity.empty()) require_dimension<Dim>(block.velocity.size(), owner.with_key("velocity"));
    for (std::size_t axis = 0; axis < block.velocity.size(); ++axis) {
      if (const auto* number = std::get_if<double>(&block.velocity[axis])) {
        constant_[axis] = *number;
      } else {
        const std::string& text = std::get<std::string>(block.velocity[axis]);
        varying_.push_back(
            {static_cast<int>(axis), text, Formula(text, named_numbers(spec), std::span(position_names).first(Dim))});
      }
    }
  }

  Vec<Dim> at(const Vec<Dim>& x) {
    Vec<Dim> velocity = constant_;
    for (Component& component : varying_) {
      velocity[component.axis] = component.formula.at({x.data(), Dim});
      if (!(std::abs(velocity[component.axis]) <= largest_number)) {  // also when it is not a number
        throw CaseError(
            "velocity-not-finite",
            {"{}[{}] = \"{}\" is {} at {}", owner_.with_key("velocity"), component.axis, component.text,
             velocity[component.axis], place(x)},
            {"give an expression that is a number of at most {:g} wherever the block has particles", largest_number});
      }
    }
    if (const double speed = velocity.norm(); speed > largest_speed_of_case) {
      throw CaseError("velocity-too-large",
                      {"{} is {:.4g} at {}, but water is treated as incompressible, which limits it to {:g} m/s",
                       owner_.with_key("velocity"), Amount{speed, "m/s"}, place(x), largest_speed_of_case},
                      {"correct its velocity"});
    }
    return velocity;
  }

 private:
  struct Component {
    int axis;
    std::string text;
    Formula formula;
  };

  CaseLabel owner_;
  Vec<Dim> constant_ = Vec<Dim>::Zero();
  std::vector<Component> varying_;
};

}  // namespace tailwater
