// Entry point of every test program: floating-point traps on.
#include <gtest/gtest.h>

#include "base/fp_traps.h"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  tailwater::enable_fp_traps();
  return RUN_ALL_TESTS();
}
