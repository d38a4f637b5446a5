#include "case/spec.h"

namespace tailwater {

CaseSpec::CaseSpec() = default;
CaseSpec::CaseSpec(const CaseSpec&) = default;
CaseSpec::CaseSpec(CaseSpec&&) noexcept = default;
CaseSpec& CaseSpec::operator=(const CaseSpec&) = default;
CaseSpec& CaseSpec::operator=(CaseSpec&&) noexcept = default;
CaseSpec::~CaseSpec() = default;

}  // namespace tailwater
