#include "walls/wall_model.h"

#include "walls/dummies.h"
#include "walls/pressure_rows.h"
#include "walls/row_and_dummies.h"

namespace tailwater {

template <int Dim>
std::unique_ptr<const WallModel<Dim>> make_wall_model(WallTreatment name) {
  switch (name) {
    case WallTreatment::pressure_rows:
      return make_pressure_rows<Dim>();
    case WallTreatment::row_and_dummies:
      return make_row_and_dummies<Dim>();
    case WallTreatment::dummies:
      break;
  }
  return make_dummies<Dim>();
}

template std::unique_ptr<const WallModel<2>> make_wall_model<2>(WallTreatment);
template std::unique_ptr<const WallModel<3>> make_wall_model<3>(WallTreatment);

}  // namespace tailwater
