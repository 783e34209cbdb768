// Wrong input: each row ends with exit code 2, prints nothing on standard output and states the rule that it breaks.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "tests/client/cli/cli_run.h"

namespace ricochet::cli {
namespace {

using testing::HasSubstr;

struct BadInput {
  Arguments arguments;
  std::string message;  // A part of the text on standard error.
  std::string input;    // The text on standard input.
};

void PrintTo(const BadInput& bad, std::ostream* stream) { *stream << bad.message; }

const Arguments kSolve = {"solve", "--a", "0.3", "--b", "1", "--mu", "0.1", "--energetic", "1"};
const Arguments kCost = {"cost", "--a", "0.3", "--b", "1", "--mu", "0.1", "--energetic", "1"};
const Arguments kSweep = {"sweep", "--a", "0.3", "--b", "1", "--energetic", "1"};

Arguments Plus(Arguments arguments, const Arguments& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

Arguments Axis(const std::string& text) { return Plus(kSweep, {"--axis", text}); }

const Arguments kSeveral = {"multicontact", "--scene", "-"};
constexpr char kTwoFeet[] =
    "free_bodies { bodies { mass_kg: 1 inertia_com_kg_m2: 0.4 position_m: [0, 1] linear_m_s: [0, -1] } } "
    "contacts { energetic: 1 relative_stiffness: 1 body: 1 point_m: [-0.5, 0] normal: [0, 1] } "
    "contacts { energetic: 1 relative_stiffness: 1 body: 1 point_m: [0.5, 0] normal: [0, 1] }";
const Arguments kSolveInput = {"solve", "--scene", "-"};
const Arguments kSweepInput = {"sweep", "--request", "-"};

std::vector<BadInput> Flags() {
  return {
      {{}, "Usage: ricochet [OPTIONS] SUBCOMMAND", ""},
      {{"solv"}, "solv is not a subcommand; did you mean solve?", ""},
      {{"--verison"}, "--verison is not an option of ricochet; did you mean --version?", ""},
      {{"scene", "lst"}, "lst is not a subcommand of ricochet scene; did you mean list?", ""},
      {{"scene"}, "ricochet scene needs a subcommand: list, template, ", ""},
      {{"frobnicate"}, "frobnicate is not a subcommand\nSubcommands: solve, bounds", ""},
      {Plus(kSolve, {"--energetik=1"}), "--energetik is not an option of ricochet solve; did you mean --energetic?",
       ""},
      {{"solve", "--energetik", "1"}, "--energetik is not an option of ricochet solve", ""},
      {Plus(kSolve, {"0.5"}), "0.5 is not expected here: must follow an option", ""},
      {{"solve"}, "no scene: give --scene FILE, or a pendulum by --a", ""},
      {{"bounds"}, "no scene", ""},
      {{"solve", "--depth", "1"}, "--depth", ""},
      {Plus(kSolve, {"extra"}), "extra", ""},
      {Plus(kSolve, {"--format", "xml"}), "--format", ""},
      {Plus(kSolve, {"--newton", "1"}), "--newton cannot be combined with --energetic: give one of them", ""},
      {Plus(kSolve, {"--scene", "x.json"}), "--scene cannot be combined with the flags of a pendulum", ""},
      {Plus(kSolve, {"--plot", "picture.gif"}), "--plot picture.gif: must end in .svg, .png or .pdf", ""},
      {Plus(kSolve, {"--history", "0"}), "--history = 0: must be in [1, 65535]", ""},
      {Plus(kSolve, {"--history", ""}), "--history: must have a value", ""},
      {Plus(kSweep, {"--threads", ""}), "--threads: must have a value", ""},
      {{"solve", "--a", "+-0.3"}, "--a = +-0.3: must be a number", ""},
      {{"solve", "--scene", std::string(300, 'a')}, "aaa: File name too long", ""},
      {{"plot", std::string(300, 'a')}, "aaa: File name too long", ""},
      {{"audit", "--a", "0.3", "--b", "1", "--data", "/tmp", "-o", "out.csv"}, "cannot read /tmp: Is a directory", ""},
      {{"conformance", "grade", "-", "--tolerance", "inf"}, "--tolerance = inf: must be above 0 and below 1e100", ""},
      {Plus(kSolve, {"--history", "65536"}), "--history = 65536: must be in [1, 65535]", ""},
      {Plus(kSolve, {"--history", "2.5"}), "--history = 2.5: must be a whole number", ""},
      {Plus(kSolve, {"--deadline", "1s"}), "--deadline needs --server", ""},
      {{"fit", "--scene", "-", "--data", "-", "--unknown", "mu"},
       "--scene - and --data - both read standard input: one must name a file",
       ""},
      {{"multicontact", "--scene", "x", "--keep", "1"}, "--keep and --composite need --mechanism FILE.npz", ""},
      {Plus(kSolve, {"--server", "localhost:1", "--deadline", "soon"}), "--deadline = soon: must be a time", ""},
      {Plus(kSolve, {"--server", "localhost:1", "--max-receive", "0"}), "--max-receive = 0: must be in [1, 2147483647]",
       ""},
      {Plus(kSolve, {"--server", "localhost:1", "--deadline", "0"}), "--deadline = 0: must be a time", ""},
      {Plus(kSolve, {"--server", "localhost"}), "target = \"localhost\": must have a port, as localhost:50051", ""},
      {Plus(kSolve, {"--server", "two words"}), "target = \"two words\": must not contain white space", ""},
      {{"cost"}, "no scene: give --scene FILE", ""},
      {{"cost", "--a", "1", "--energetic", "2"}, "restitution.energetic = 2: must be in [0, 1]", ""},
      {Plus(kCost, {"--time-limit", "soon"}), "--time-limit = soon: must be a time", ""},
      {Plus(kCost, {"--time-limit", "2m"}), "time_limit_s = 120: must be", ""},
      {{"cost", "--scene", "-", "--plot", "p.svg"}, "--plot p.svg: must be left out, because", "contacts {}"},
      {{"cost", "--scene", "-", "--html", "p.html"}, "--html p.html: must be left out, because", "contacts {}"},
      {{"cost", "--scene", "-"},
       "is not a ricochet.v1.MultiContactScene in textproto: line 1, column 14",
       "contacts { mu: 1 }"},
      {{"scene", "print", "--scene", "-"}, "contacts[0].friction = -1: must be", "contacts { friction: -1 }"},
      {{"scene", "print", "--scene", "-"},
       "is not a ricochet.v1.Scene in textproto: line 2, column 19",
       "# One of two contacts.\nplanar_body { mass: 1 }"},
      {{"scene", "print", "--scene", "-"}, "ricochet.v1.Scene has no field \"planar_contacts\"", "planar_contacts {}"},
      {Plus(kCost, {"--samples", "0"}), "--samples = 0: must be in [1, 1001]", ""},
      {Plus(kCost, {"--plot", "picture.gif"}), "--plot picture.gif: must end in .svg, .png or .pdf", ""},
      {Plus(kCost, {"--deadline", "1s"}), "--deadline needs --server", ""},
      {Plus(kSweep, {"--column", "nweton"}), "--column nweton: names nothing; did you mean coefficients.newton?", ""},
      {Plus(kSweep, {"--axis", "kinetc_coefficient=1"}),
       "kinetc_coefficient: names nothing; did you mean friction.kinetic_coefficient?", ""},
      {Plus(kSweep, {"--fan-out"}), "--fan-out needs --server A,B,...", ""},
      {Plus(kSweep, {"--fan-out", "--server", "localhost:1"}),
       "--server = localhost:1: must name at least two servers, separated by commas, for --fan-out", ""},
      {{"health"}, "--server is required", ""},
      {{"solve", "--scene", "/proc/self/mem"}, "cannot read /proc/self/mem: Input/output error", ""},
      {{"audit", "--a", "0.3", "--data", "/proc/self/mem"}, "cannot read /proc/self/mem: Input/output error", ""},
      {Plus(kSolve, {"--force-history", "2"}), "--force-history: force_intervals = 2: must not be asked", ""},
      {Plus(kSolve, {"--derivatives", "newton", "--by", "mu,foo"}), "--by foo: derivatives.by[1] = \"foo\": must be",
       ""},
      {{"solve", "--a", "long"}, "--a = long: must be a number such as 0.1", ""},
      {{"solve", "--a", ""}, "--a: must have a value", ""},
      {{"solve", "--a", "1e999"}, "--a = 1e999: must be 0, or a number of a size from 4.95e-324 to 1.797", ""},
      {{"solve", "--a", "0,3"}, "--a = 0,3: must be a number with a decimal point, not a comma", ""},
      {{"solve", "--a", "3deg"}, "--a = 3deg: must be a number without deg, because it is no angle", ""},
      {{"solv", "--help"}, "solv is not a subcommand; did you mean solve?", ""},
      {{"help", "solv"}, "solv is not a subcommand; did you mean solve?", ""},
      {Plus(kSolve, {"--require", "finite-durration"}), "did you mean finite-duration?", ""},
      {Plus(kSolve, {"--skip-column", "id"}), "--column and --skip-column need --data FILE.csv", ""},
      {Plus(kSolve, {"--history", "2", "--explain", "--format", "csv"}),
       "--history, --explain cannot be combined as csv, which is one table: give one of them, or --format json", ""},
      {Plus(kSolve, {"--certified", "9", "--derivatives", "newton", "--by", "mu", "--format", "csv"}),
       "--certified, --derivatives cannot be combined as csv", ""},
      {Plus(kSolve, {"--both-ends", "--force-history", "2", "-o", "x.csv"}),
       "--force-history, --both-ends cannot be combined as csv", ""},
      {{"bounds", "--a", "1", "--certified", "9", "--range", "mu=0:1", "--format", "csv"},
       "--range, --certified cannot be combined as csv",
       ""},
      {{"bounds", "--a", "1", "--derivatives", "newton", "--by", "mu", "--range", "mu=0:1", "--format", "csv"},
       "--range, --derivatives cannot be combined as csv",
       ""},
      {Plus(kSeveral, {"--function", "body_1.x=1,0,0"}),
       "--function body_1.x=1,0,0: outputs[0].name = \"body_1.x\": must not name another", kTwoFeet},
      {Plus(kSeveral, {"--function", "f=1,0,0", "--function", "f=0,1,0"}),
       "--function f=0,1,0: outputs[1].name = \"f\": must not name another output", kTwoFeet},
      {Plus(kSeveral, {"--function", "f=1,0,0", "--method", "orders"}), "--function needs --method possible", kTwoFeet},
      {Plus(kSeveral, {"--stiffness-ratio", "2=1:2", "--method", "orders,possible"}),
       "--stiffness-ratio needs --method springs", kTwoFeet},
      {Plus(kSolve, {"--server=", "--tls"}), "--server=: must have a value", ""},
      {{"solve", "--mu=", "--energetic=1"}, "--mu=: must have a value", ""},
      {{"solve", "--mu", "--energetic=1"}, "--mu: must have a value, before the option --energetic=1", ""},
      {Plus(kSolve, {"-o=x.csv"}), "-o=x.csv: must be -o x.csv", ""},
      {{"solve", "--", "--energetic", "1"},
       "--energetic is not expected here: must stand behind ricochet solve and",
       ""},
      {{"solve", "--mu-s", "1"}, "--mu-s is not an option of ricochet solve; did you mean --mu-static?", ""},
      {{"sweep", "--column", "?", "--format", "json"}, "--format = json: must be text, because ? lists names", ""},
      {{"sweep", "--axis", "?", "-o", "x.csv"}, "--format = csv: must be text, because ? lists names", ""},
      {{"solve", "--a", "1", "--mu", "1/0"}, "--mu = 1/0: must have a denominator other than 0", ""},
      {{"solve", "--a", "1", "--mu", "1/2/3"}, "--mu = 1/2/3: must be a number", ""},
  };
}

std::vector<BadInput> Scenes() {
  return {
      {{"solve", "--b", "1", "--energetic", "1"}, "--a (not given): pendulum.a_m = 0: must be > 0\n", ""},
      {{"solve", "--a", "0", "--energetic", "1"}, "--a: pendulum.a_m = 0: must be > 0\n", ""},
      {kSolveInput, "ricochet.v1.Pendulum has no field \"inertia_kgm2\"; did you mean inertia_kg_m2?",
       "pendulum { inertia_kgm2: 1 }"},
      {kSolveInput, "pendulum.a_m = 0: must be > 0\n",
       "pendulum { inertia_kg_m2: 0 omega_minus_rad_s: -1 } restitution { energetic: 1 }"},
      {{"solve", "--a", "1"}, "restitution.coefficient is not set: must be one of newton, poisson, energetic", ""},
      {{"solve", "--a", "-0.3", "--energetic", "1"}, "pendulum.a_m = -0.3: must be > 0", ""},
      {{"solve", "--a", "inf", "--energetic", "1"}, "pendulum.a_m = inf: must be finite", ""},
      {{"solve", "--a", "1", "--b", "nan", "--energetic", "1"}, "pendulum.b_m = nan: must be finite", ""},
      {{"solve", "--a", "1", "--inertia", "0", "--energetic", "1"}, "pendulum.inertia_kg_m2 = 0: must be > 0", ""},
      {{"solve", "--a", "1", "--omega", "-inf", "--energetic", "1"}, "pendulum.omega_minus_rad_s = -inf: must be", ""},
      {{"bounds", "--a", "1", "--mu", "-0.1"}, "friction.kinetic_coefficient = -0.1: must be >= 0", ""},
      {{"bounds", "--a", "1", "--mu", "0.2", "--mu-static", "0.1"},
       "friction.static_coefficient = 0.1: must be >= friction.kinetic_coefficient = 0.2",
       ""},
      {{"bounds", "--a", "1", "--range", "pendulum.a_m"}, "--range = pendulum.a_m: must be PATH=LOW:HIGH", ""},
      {{"bounds", "--a", "1", "--range", "pendulum.phi_rad=30:45"},
       "--range pendulum.phi_rad=30:45: ranges[0].low = 30: must be in (0, pi)",
       ""},
      {{"bounds", "--a", "1", "--range", "pendulum.a_m=0:1"}, "ranges[0].low = 0: must be > 0", ""},
      {{"solve", "--a", "1", "--newton", "-0.5"}, "restitution.newton = -0.5: must be >= 0", ""},
      {{"solve", "--a", "1", "--poisson", "-0.5"}, "restitution.poisson = -0.5: must be >= 0", ""},
      {{"solve", "--a", "1", "--energetic", "1.5"}, "restitution.energetic = 1.5: must be in [0, 1]", ""},
      {{"solve", "--scene", "no/such/file"}, "cannot read no/such/file: No such file", ""},
      {{"solve", "--scene", "."}, "cannot read .", ""},
      {{"plot", "no/such/file"}, "cannot read no/such/file: No such file", ""},
      {kSolveInput, "is empty", ""},
      {kSolveInput, "system is not set: must be one of pendulum", "{}"},
      {{"solve", "--a", "0.3", "--b"}, "--b: must have a value", ""},
      {{"solve", "--mu", "0.1", "--mu", "0.2"}, "--mu: is given 2 times: must be given once", ""},
      {kSolveInput,
       "nothing strikes, because all velocities of the scene are 0: must have another value in "
       "pendulum.omega_minus_rad_s",
       R"({"pendulum": {"inertia_kg_m2": 1, "a_m": 0.3}, "restitution": {"energetic": 1}})"},
      {{"bounds", "--scene", "-"},
       "planar_contact.tangential_m_s, planar_contact.normal_m_s",
       "planar_contact { w_tt_per_kg: 1 w_nn_per_kg: 1 }"},
      {kSolveInput, "standard input is not a ricochet.v1.Scene in JSON", "{\"pendulum\": {"},
      {kSolveInput, "mass", R"({"pendulum": {"mass": 1}})"},
      {kSolveInput, "a_m", R"({"pendulum": {"a_m": "wide"}})"},
      {kSolveInput, "in JSON: line 3, column 11: pendulum.inertia: is no field of Pendulum",
       "{\n \"pendulum\": {\n  \"inertia\": 1}}"},
      {kSolveInput, "line 2, column 24: pendulum.a_n: is no field of Pendulum; did you mean a_m?",
       "{\n   \"pendulum\": {   \"a_n\": 1}}"},
      {kSolveInput, "line 2, column 17: planar_body: cannot be given beside pendulum: there is one system only",
       "{\"pendulum\": {},\n \"planar_body\": {}}"},
      {kSolveInput,
       "pendulum.inertia_kg: is no field of Pendulum; its fields are inertia_kg_m2, a_m, b_m, omega_minus_rad_s",
       R"({"pendulum": {"inertia_kg": 1}})"},
      {kSolveInput, "has no field \"mass_kg\"; its fields are inertia_kg_m2, a_m, b_m, omega_minus_rad_s",
       "pendulum { mass_kg: 1 }"},
      {kSolveInput, "pendulum.a_m = 1e400: must be 0, or a number of a size from 4.95e-324 to 1.7976",
       R"({"pendulum": {"a_m": 1e400}})"},
      {kSolveInput, "pendulum.a_m = 1e-400: must be 0, or a number of", R"({"pendulum": {"a_m": 1e-400}})"},
      {kSolveInput, "pendulum.a_m = -1e-400: must be 0, or a number of", R"({"pendulum": {"a_m": "-1e-400"}})"},
      {kSolveInput, "pendulum.a_m = \"0x10\": must be a number", R"({"pendulum": {"a_m": "0x10"}})"},
      {kSolveInput, "w_per_kg has 1e400: must be 0, or a number of",
       R"({"planar_contact": {"w_per_kg": [[1e400, 0], []]}})"},
      {kSolveInput, "w_per_kg has 1e-400: must be 0, or a number of",
       R"({"planar_contact": {"w_per_kg": [[1, 1e-400]]}})"},
      {kSolveInput, "line 1, column 17: 1e-400 must be 0, or a number of", "pendulum { a_m: 1e-400 }"},
      {kSolveInput, "line 2, column 17: pendulum.a_m: is given twice",
       "{\"pendulum\": {\"a_m\": 1,\n            \"a_m\": 1}}"},
      {kSolveInput, "pendulum.aM: is given twice, before as a_m", R"({"pendulum": {"a_m": 0.3, "b_m": 1, "aM": 3}})"},
      {kSolveInput, "pendulum.a_m: is given twice, before as aM", R"({"pendulum": {"aM": 2, "a_m": 3}})"},
      {kSolveInput, "line 1, column 41: friction.kinetic_coefficient = null: must have a value, or be left out",
       R"({"friction": {"kinetic_coefficient": null}})"},
      {kSolveInput, "spatial_contact.tangential_m_s[1] = null: must have a value, or be left out",
       R"({"spatial_contact": {"tangential_m_s": [1, null]}})"},
      {kSolveInput, "mechanism.rates[2] = \"fast\": must be a number", R"({"mechanism": {"rates": [1, 2, "fast"]}})"},
      {kSweepInput, "in JSON: required = 99: must be a number of ricochet.v1.Effect", R"({"required": [99]})"},
      {kSweepInput, "in textproto: required = 99: must be a number of", "required: 99"},
      {kSolveInput, "linkage.links[0] = null: must have a value", R"({"linkage": {"links": [null]}})"},
      {kSolveInput, "line 1, column 43: friction: is given twice",
       R"({"friction": {}, "pendulum": {}, "friction": {}})"},
      {kSolveInput, "linkage.links[1].mass_kg: is given twice",
       R"({"linkage": {"links": [{"mass_kg": 1}, {"mass_kg": 1, "mass_kg": 2}]}})"},
      {kSolveInput, "line 1, column 24: syntax error", R"({"pendulum": {"a_m": 1,,}})"},
      {kSolveInput, "line 1, column 46: linkage.links[1].mass_kg = \"heavy\": must be a number",
       R"({"linkage": {"links": [{}, {"mass_kg": "heavy"}]}})"},
      {kSolveInput, R"(line 1, column 25: "planar_body" cannot be given beside "pendulum": there is one system only)",
       "pendulum {} planar_body {}"},
      {kSolveInput, "standard input has several contacts: `ricochet multicontact --scene` takes it",
       "contacts { friction: 1 } contacts { friction: 1 }"},
      {{"multicontact", "--scene", "-"},
       "standard input has one contact: `ricochet solve --scene` takes it",
       R"({"pendulum": {"a_m": 1}})"},
      {kSolveInput, "is not a ricochet.v1.Scene in textproto: line 2, column 7", "pendulum {\n  mass: 1\n}"},
      {kSolveInput, "restitution.energetic = 2: must be in [0, 1]",
       "pendulum { inertia_kg_m2: 1 a_m: 1 } restitution { energetic: 2 }"},
  };
}

std::vector<BadInput> Sweeps() {
  const Arguments request_and_axis = Plus(kSweepInput, {"--axis", "pendulum.a_m=1"});
  return {
      {Axis("pendulum.a_m"), "--axis = pendulum.a_m: must be PATH=VALUES", ""},
      {Axis("=1,2"), "must be PATH=VALUES", ""},
      {Axis("pendulum.a_m="), "must be a number", ""},
      {Axis("pendulum.a_m=1,,2"), "must be a number", ""},
      {Axis("pendulum.a_m=1:2:3"), "must be a list such as 0.1,1/3 or lin:START:STOP:COUNT", ""},
      {Axis("pendulum.a_m=lin:1:2"), "lin with 2 parts: must be lin:START:STOP:COUNT", ""},
      {Axis("pendulum.a_m=lin:x:2:3"), "--axis pendulum.a_m, START = x: must be a number", ""},
      {Axis("pendulum.a_m=lin:1:2:3.5"), "--axis pendulum.a_m, COUNT = 3.5: must be a whole number", ""},
      {Axis("pendulum.a_m=lin:1:2:0"),
       "--axis pendulum.a_m=lin:1:2:0: axes[0].linspace.count = 0: must be in [1, 2^53]", ""},
      {Axis("pendulum.a_m=0.001,0.002,0.003,0.004,0.005,0.006,0.007,0.008,0.009,0.010,0.011,0.012,inf"),
       "--axis pendulum.a_m=0.001,0.002,0.003,0.004,0.005,0.006,0.007,0.008,0.009,0.010,0.011,0...: "
       "axes[0].list.values[12] = inf",
       ""},
      {Axis("pendulum.a_m=lin:1:inf:3"), "axes[0].linspace.stop = inf: must be finite", ""},
      {Axis("pendulum.a_m=log:0:1:3"), "axes[0].logspace.start = 0: must be finite and > 0", ""},
      {Axis("pendulum.mass_kg=1"),
       "axes[0].path = \"pendulum.mass_kg\": must be a field that the scene states; `ricochet sweep --axis '?'` lists "
       "them\n",
       ""},
      {Plus(Axis("pendulum.a_m=1"), {"--axis", "pendulum.phi_rad=1"}), "axes[1].path", ""},
      {Plus(Axis("pendulum.a_m=lin:1:2:1e9"), {"--axis", "pendulum.b_m=lin:1:2:1e9"}), "more than 2^53 points", ""},
      {Plus(Axis("pendulum.a_m=1,2"), {"--zip", "--axis", "pendulum.b_m=1,2,3"}),
       "have 2 values of pendulum.a_m and 3 of pendulum.b_m", ""},
      {Plus(kSweep, {"--column", "coefficients.elastic"}),
       "columns[0] = \"coefficients.elastic\": must be a column of the scene", ""},
      {Plus(kSweep, {"--column", "energy_change_j,energy_change_j"}), "columns[1]", ""},
      {Plus(kSweep, {"--column", "coefficients.*,energy_change_j,energy_change_j"}), "--column: columns[5]", ""},
      {Plus(kSweep, {"--column", "normal_total"}),
       "--column normal_total: must name one of\n  impulse.normal_total_n_s\n  work.normal_total_j\n", ""},
      {Plus(kSweep, {"--threads", "0"}), "--threads = 0: must be a whole number from 1 to 1024", ""},
      {Plus(kSweep, {"--threads", "-2"}), "--threads = -2: must be a whole number from 1 to 1024", ""},
      {Plus(kSweep, {"--threads", "2.5"}), "--threads = 2.5: must be a whole number from 1 to 1024", ""},
      {Plus(kSweep, {"--threads", "2", "--server", "127.0.0.1:1"}),
       "--threads = 2: must not be given with the server 127.0.0.1:1, which computes with threads of its own", ""},
      {Plus(kSweep, {"--range", "5"}), "--range = 5: must be FIRST:END", ""},
      {Plus(kSweep, {"--range", "0:2"}), "end_index = 2: must be in [0, 1]", ""},
      {Plus(kSweep, {"--range", "-1:1"}), "first_index = -1: must be in [0,", ""},
      {{"sweep", "--a", "0.3", "--axis", "pendulum.b_m=1"}, "restitution.coefficient is not set", ""},
      {request_and_axis, "--request cannot be combined with the flags", ""},
      {kSweepInput, "is not a ricochet.v1.SweepRequest in JSON", R"({"axis": []})"},
      {kSweepInput, "endIndex: is given twice, before as end_index", R"({"end_index": 1, "endIndex": 2})"},
      {Axis("mu=1,2deg"), "--axis friction.kinetic_coefficient = 2deg: must be a number without deg", ""},
      {kSweepInput, "columns is empty: must name at least one",
       "scene { pendulum { inertia_kg_m2: 1 a_m: 1 } restitution { newton: 1 } }"},
  };
}

class CliBadInput : public CliTest, public testing::WithParamInterface<BadInput> {};

INSTANTIATE_TEST_SUITE_P(Flags, CliBadInput, testing::ValuesIn(Flags()));
INSTANTIATE_TEST_SUITE_P(Scenes, CliBadInput, testing::ValuesIn(Scenes()));
INSTANTIATE_TEST_SUITE_P(Sweeps, CliBadInput, testing::ValuesIn(Sweeps()));

TEST_P(CliBadInput, IsNamedWithWhatWouldBeRight) {
  const CliResult result = Run(GetParam().arguments, GetParam().input);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr(GetParam().message));
}

class CliBadInputLines : public CliTest {};

TEST_F(CliBadInputLines, ThereIsOneForEachViolation) {
  const CliResult result = Run({"solve", "--a", "-1", "--mu", "-0.1", "--newton", "-2"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err,
            "--a: pendulum.a_m = -1: must be > 0\n"
            "--mu: friction.kinetic_coefficient = -0.1: must be >= 0\n"
            "--newton: restitution.newton = -2: must be >= 0\n");
}

TEST_F(CliBadInputLines, AllUnreadableNumbersAreReportedAtOnce) {
  const CliResult result = Run({"solve", "--a", "x", "--mu", "y"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("--a = x"));
  EXPECT_THAT(result.err, HasSubstr("--mu = y"));
}

}  // namespace
}  // namespace ricochet::cli
