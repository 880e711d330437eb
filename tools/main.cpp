// delvox: CT and MRI volumes to surface and tetrahedral meshes. This file holds the table of verbs and the one place
// where errors become exit codes; each verb has a file of its own.

#include <exception>
#include <filesystem>
#include <new>
#include <string>

#include "console.h"
#include "core/output_file.h"
#include "exit_codes.h"
#include "format.h"
#include "signals.h"
#include "verbs.h"

namespace delvox::tools {
namespace {

constexpr Verb kVerbs[] = {
    {"info", "INPUT", "what is in this scan, or in these samples; which isovalues make sense", run_info},
    {"surface", "INPUT -o MESH", "triangle mesh of an isosurface of a volume, samples or a formula (DelSurf)", run_surface},
    {"remesh", "SURFACE -o MESH", "new triangle mesh of a closed polygon surface (SurfRemesh)", run_remesh},
    {"tet", "INPUT -o MESH", "tetrahedral mesh of what an isosurface, a polygon surface or a formula encloses", run_tet},
    {"check", "MESH...", "is a mesh what it promises; how far is it from the voxels", run_check},
    {"convert", "MESH -o OUT", "between mesh formats", run_convert},
    {"phantom", "KIND -o VOLUME", "test volumes with known answers", run_phantom},
};

constexpr const char* kExitCodes =
    "Exit codes: 0 done, every promise verified; 2 usage; 3 input cannot be read; 4 nothing to mesh; 5 a limit stopped\n"
    "the run or a promise does not hold (what there is was written), or the forecast exceeds --max-memory (nothing\n"
    "was); 6 output cannot be written; 130 cancelled.\n";

std::string overview() {
  std::string text = "delvox " DELVOX_VERSION ": Delaunay meshes of organs from CT and MRI volumes\n\n";
  for (const Verb& verb : kVerbs) {
    std::string usage = std::string("  delvox ") + verb.name + " " + verb.arguments;
    usage.resize(34, ' ');
    text += usage + verb.summary + "\n";
  }
  return text + "\ndelvox VERB --help tells the options of a verb. Lengths are in millimetres, angles in degrees.\n" +
         kExitCodes;
}

const Verb& find_verb(const std::string& name) {
  for (const Verb& verb : kVerbs) {
    if (name == verb.name) return verb;
  }
  throw OptionError("no verb '" + name + "'; see delvox --help");
}

void run(const Arguments& arguments) {
  if (arguments.empty()) throw OptionError("what to do? Give a verb; see delvox --help");
  const std::string& first = arguments.front();
  if (first == "--help" || first == "-h" || first == "help") {
    write_stdout(overview());
  } else if (first == "--version") {
    write_stdout("delvox " DELVOX_VERSION "\n");
  } else {
    const Verb& verb = find_verb(first);
    verb.run(verb, Arguments(arguments.begin() + 1, arguments.end()));
  }
}

int fail(int code, const std::string& message) {
  write_stderr("delvox: " + one_line(message) + "\n");
  return code;
}

// The one place where errors become exit codes.
int run_and_map_errors(const Arguments& arguments) {
  try {
    run(arguments);
    return kExitDone;
  } catch (const OptionError& error) {
    return fail(kExitUsage, error.what());
  } catch (const InputError& error) {
    return fail(kExitInput, error.what());
  } catch (const NothingToMesh& error) {
    return fail(kExitNothing, error.what());
  } catch (const PromiseBroken& error) {
    return fail(kExitBroken, error.what());
  } catch (const RunRefused& error) {
    return fail(kExitBroken, error.what());
  } catch (const IoError& error) {
    return fail(kExitOutput, error.what());
  } catch (const Cancelled&) {
    return fail(kExitCancelled, "cancelled by " + cancelled_by() + "; nothing is left half-written");
  } catch (const std::bad_alloc&) {
    return fail(kExitBroken, "out of memory; give a larger --size, or --crop or --resample the volume");
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(kExitOutput, error.what());
  } catch (const std::exception& error) {
    return fail(kExitBroken, std::string("internal error: ") + error.what() + "; please report it");
  }
}

}  // namespace
}  // namespace delvox::tools

int main(int argc, char** argv) {
  delvox::tools::install_signal_handlers();
  const int code = delvox::tools::run_and_map_errors({argv + 1, argv + argc});
  delvox::remove_unfinished_outputs();
  return code;
}
