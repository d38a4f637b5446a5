// A program of one's own that runs a case: a_run CASE.toml DIR
#include "case/reader.h"
#include "linear/session.h"
#include "run/run_case.h"

int main(int, char** arguments) {
  const tailwater::LinearSession session;
  const tailwater::CaseSpec spec = tailwater::read_case(arguments[1]);
  return static_cast<int>(tailwater::run_case(spec, {.case_file = arguments[1], .out = arguments[2]}));
}
