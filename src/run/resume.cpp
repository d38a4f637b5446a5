#include "run/resume.h"

#include <fmt/format.h>

#include <optional>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/text.h"
#include "case/reader.h"
#include "case/writer.h"
#include "io/messages.h"
#include "io/run_folder.h"
#include "io/sealed_file.h"
#include "parallel/together.h"
#include "results/provenance.h"
#include "results/summary_file.h"
#include "run/checkpoint.h"
#include "run/run_case.h"

namespace tailwater {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view changeable_keys =
    "time.end, output.fields_interval, output.view_interval and output.checkpoint_interval";

/// The case with its changeable keys taken from `other`.
CaseSpec with_changeable_keys_of(const CaseSpec& other, CaseSpec spec) {
  spec.time.end = other.time.end;
  spec.output.fields_interval = other.output.fields_interval;
  spec.output.view_interval = other.output.view_interval;
  spec.output.checkpoint_interval = other.output.checkpoint_interval;
  return spec;
}

/// All keys of a case as "[table] key = value", in order.
std::vector<std::string> keys_of_case(const CaseSpec& spec) {
  const std::string text = effective_case(spec);
  std::vector<std::string> keys;
  std::string table;
  for (const std::string_view line : lines_of(text)) {
    if (line.starts_with('[')) table = line;
    if (line.empty() || line.starts_with('[') || line.starts_with('#')) continue;
    keys.push_back(fmt::format("{} {}", table, line.substr(0, line.find("  # "))));
  }
  return keys;
}

/// The newest intact checkpoint; empty if there is no checkpoint. Warns of damaged ones.
std::optional<SealedFile> find_checkpoint(const RunOptions& options, fs::path& found) {
  std::string problems;
  for (const fs::path& path : checkpoints_in(options.out)) {
    try {
      SealedFile file = read_sealed_file(path);
      if (!problems.empty()) warn("checkpoint-damaged", "{}; continuing from '{}'", problems, path.string());
      found = path;
      return file;
    } catch (const IoError& error) {
      problems += fmt::format("{}{}", problems.empty() ? "" : "; ", error.what());
    }
  }
  if (problems.empty()) return std::nullopt;
  throw IoError("{}; remedy: start again with tailwater run {} --out {} --force", problems,
                (options.out / effective_case_name).string(), options.out.string());
}

void require_readable_format(const SealedFile& file, const fs::path& path) {
  if (file.format == checkpoint_format) return;
  throw InputError(
      "checkpoint '{}' has format {}, and this program, {}, reads format {}; remedy: resume with the program that "
      "wrote it, {}",
      path.string(), file.format, version_line(), checkpoint_format, file.writer);
}

/// Warns if another program wrote the checkpoint: it computes the same flow with other last digits.
void tell_of_another_writer(const SealedFile& file) {
  if (file.writer == version_line()) return;
  warn("checkpoint-of-other-version",
       "the checkpoint was written by {}, and this is {}: the last digits of results may differ", file.writer,
       version_line());
}

void require_same_case(const CaseSpec& spec, const CaseSpec& saved, const fs::path& path, const fs::path& case_file) {
  if (with_changeable_keys_of(spec, saved) == spec) return;
  throw InputError(
      "checkpoint '{}' belongs to another case than '{}': {}; remedy: restore the case that was run, or start another "
      "run",
      path.string(), case_file.string(), first_difference(with_changeable_keys_of(spec, saved), spec));
}

void require_allowed(const CaseSpec& before, const CaseSpec& after) {
  const CaseSpec allowed = with_changeable_keys_of(after, before);
  if (allowed == after) return;
  throw InputError(
      "--set: a resumed run keeps its case, and here {}; it may change {}; remedy: tailwater run with another --out",
      first_difference(allowed, after), changeable_keys);
}

/// An earlier end would cut off results that the run has written.
void require_end_ahead(const CaseSpec& before, const CaseSpec& after, const SealedFile& checkpoint) {
  if (after.time.end >= before.time.end) return;
  const double reached = time_of_checkpoint(checkpoint);
  if (after.time.end >= reached) return;
  throw InputError(
      "--set: time.end = {:.6g} s is before {:.6g} s, which the run has reached; remedy: give a later end, or start "
      "another run with another --out",
      after.time.end, reached);
}

}  // namespace

std::string first_difference(const CaseSpec& wanted, const CaseSpec& found) {
  const std::vector<std::string> a = keys_of_case(wanted);
  const std::vector<std::string> b = keys_of_case(found);
  std::size_t k = 0;
  while (k < a.size() && k < b.size() && a[k] == b[k]) ++k;
  return fmt::format("it has {} instead of {}", k < b.size() ? b[k] : "no more keys",
                     k < a.size() ? a[k] : "no more keys");
}

ExitCode resume_run(RunOptions options, const std::vector<std::string>& overrides, const Communicator& ranks) {
  const fs::path case_file = options.out / effective_case_name;
  do_on_root(ranks, [&] {
    std::error_code error;
    if (!fs::exists(case_file, error)) {
      throw InputError(
          "'{}' is not the folder of a run: it has no {}; remedy: name the folder that a run was given by --out",
          options.out.string(), effective_case_name);
    }
    FolderLock::require_free(options.out);  // before reading files that a running run replaces
  });
  const CaseSpec before = read_effective_case(case_file);
  const CaseSpec spec = read_effective_case(case_file, overrides);
  require_allowed(before, spec);
  std::optional<SealedFile> checkpoint;
  do_on_root(ranks, [&] {
    fs::path path;
    checkpoint = find_checkpoint(options, path);
    if (!checkpoint) return;
    require_readable_format(*checkpoint, path);
    require_same_case(before, case_of_checkpoint(*checkpoint), path, case_file);
    require_end_ahead(before, spec, *checkpoint);
    tell_of_another_writer(*checkpoint);
  });
  options.case_file = case_file;
  if (ranks.any(checkpoint.has_value())) {
    if (!checkpoint) checkpoint.emplace();
    return run_case(spec, options, ranks, &*checkpoint);
  }
  tell("there is no checkpoint yet: starting again");
  const fs::path named = case_named_in(options.out / summary_name);
  if (!named.empty()) options.case_file = named;
  options.force = true;
  return run_case(spec, options, ranks);
}

int ranks_of_run(const fs::path& run) {
  try {
    for (const fs::path& path : checkpoints_in(run)) return read_head_of_sealed_file(path).ranks;
  } catch (const IoError&) {
    // `resume_run` reports the problem.
  }
  return ranks_named_in(run / summary_name);
}

}  // namespace tailwater
