#include "parallel/space_cuts.h"

#include <zoltan.h>

#include "base/error.h"
#include "base/fp_traps.h"

namespace tailwater {
namespace {

/// Input that Zoltan queries while it divides space.
template <int Dim>
struct Points {
  std::span<const Vec<Dim>> place;
  std::span<const double> weight;

  static int count(void* data, int* error) {
    *error = ZOLTAN_OK;
    return static_cast<int>(static_cast<Points*>(data)->place.size());
  }
  static void list(void* data, int, int, ZOLTAN_ID_PTR global, ZOLTAN_ID_PTR local, int, float* weights, int* error) {
    const Points& points = *static_cast<Points*>(data);
    for (std::size_t i = 0; i < points.place.size(); ++i) {
      global[i] = local[i] = i;  // Zoltan returns no lists, so ids need not differ between ranks
      weights[i] = static_cast<float>(points.weight[i]);
    }
    *error = ZOLTAN_OK;
  }
  static int dimension(void*, int* error) {
    *error = ZOLTAN_OK;
    return Dim;
  }
  static void places(void* data, int, int, int count, ZOLTAN_ID_PTR, ZOLTAN_ID_PTR local, int, double* coordinates,
                     int* error) {
    const Points& points = *static_cast<Points*>(data);
    for (int k = 0; k < count; ++k) {
      for (int d = 0; d < Dim; ++d) coordinates[Dim * k + d] = points.place[local[k]][d];
    }
    *error = ZOLTAN_OK;
  }
};

void check_zoltan(int code) {
  if (code == ZOLTAN_FATAL || code == ZOLTAN_MEMERR) throw SolverError("Zoltan could not share the particles out");
}

}  // namespace

template <int Dim>
struct SpaceCuts<Dim>::Zoltan {
  Zoltan_Struct* handle = nullptr;
  bool are_made = false;

  explicit Zoltan(const Communicator& ranks) {
    float version = 0.0F;
    check_zoltan(Zoltan_Initialize(0, nullptr, &version));
    handle = Zoltan_Create(ranks.handle());
    if (handle == nullptr) throw SolverError("Zoltan does not start");
    const auto set = [&](const char* name, const char* value) { check_zoltan(Zoltan_Set_Param(handle, name, value)); };
    set("DEBUG_LEVEL", "0");
    set("LB_METHOD", "RCB");
    set("OBJ_WEIGHT_DIM", "1");
    set("RETURN_LISTS", "NONE");
    set("KEEP_CUTS", "1");
    set("REMAP", "0");
    set("IMBALANCE_TOL", "1.01");
    set("RCB_REUSE", "1");
  }
  ~Zoltan() { Zoltan_Destroy(&handle); }
  Zoltan(const Zoltan&) = delete;
  Zoltan& operator=(const Zoltan&) = delete;
};

template <int Dim>
SpaceCuts<Dim>::SpaceCuts(const Communicator& ranks)
    : ranks_(ranks), zoltan_(ranks.is_alone() ? nullptr : std::make_unique<Zoltan>(ranks)) {}

template <int Dim>
SpaceCuts<Dim>::~SpaceCuts() = default;
template <int Dim>
SpaceCuts<Dim>::SpaceCuts(SpaceCuts&&) noexcept = default;
template <int Dim>
SpaceCuts<Dim>& SpaceCuts<Dim>::operator=(SpaceCuts&&) noexcept = default;

template <int Dim>
void SpaceCuts<Dim>::cut(std::span<const Vec<Dim>> points, std::span<const double> weights) {
  if (!zoltan_) return;
  const SuspendFpTraps suspended;
  Points<Dim> asked{points, weights};
  Zoltan_Struct* const handle = zoltan_->handle;
  Zoltan_Set_Num_Obj_Fn(handle, Points<Dim>::count, &asked);
  Zoltan_Set_Obj_List_Fn(handle, Points<Dim>::list, &asked);
  Zoltan_Set_Num_Geom_Fn(handle, Points<Dim>::dimension, &asked);
  Zoltan_Set_Geom_Multi_Fn(handle, Points<Dim>::places, &asked);
  int has_changed = 0;
  int global_size = 0;
  int local_size = 0;
  int imports = 0;
  int exports = 0;
  ZOLTAN_ID_PTR ids[4] = {};
  int* numbers[4] = {};
  check_zoltan(Zoltan_LB_Partition(handle, &has_changed, &global_size, &local_size, &imports, &ids[0], &ids[1],
                                   &numbers[0], &numbers[1], &exports, &ids[2], &ids[3], &numbers[2], &numbers[3]));
  zoltan_->are_made = true;
}

template <int Dim>
bool SpaceCuts<Dim>::are_made() const {
  return zoltan_ && zoltan_->are_made;
}

template <int Dim>
std::string SpaceCuts<Dim>::bytes() const {
  if (!are_made()) return "";
  std::string bytes(Zoltan_Serialize_Size(zoltan_->handle), '\0');
  check_zoltan(Zoltan_Serialize(zoltan_->handle, bytes.size(), bytes.data()));
  return bytes;
}

template <int Dim>
void SpaceCuts<Dim>::restore(std::string bytes) {
  zoltan_ = std::make_unique<Zoltan>(ranks_);
  check_zoltan(Zoltan_Deserialize(zoltan_->handle, bytes.size(), bytes.data()));
  zoltan_->are_made = true;
}

template <int Dim>
int SpaceCuts<Dim>::part_of(const Vec<Dim>& place) const {
  if (!zoltan_) return 0;
  Vec<Dim> coordinates = place;
  int rank = 0;
  int part = 0;
  check_zoltan(Zoltan_LB_Point_PP_Assign(zoltan_->handle, coordinates.data(), &rank, &part));
  return rank;
}

template class SpaceCuts<2>;
template class SpaceCuts<3>;

}  // namespace tailwater
