// Wrong experiment files, each with its whole message. The CSV files' own table is in csv_test.cpp.

#include "base/errors.hpp"
#include "identification/effects/catalogue.hpp"
#include "identification/fitting/experiment.hpp"
#include "tests/identification/valid_experiment.hpp"
#include "tests/support/refusal.hpp"

#include <gtest/gtest.h>

#include <string>

namespace snare::identification {
namespace {

std::string message_of(const std::string& text) {
  return test::refusal([&] { return parse_experiment("x.toml", text, parameters()); });
}

struct WrongFile {
  const char* from;  // passage of the valid file
  const char* to;    // what stands in its place
  const char* message;
};

class WrongExperiment : public testing::TestWithParam<WrongFile> {};

TEST_P(WrongExperiment, HasItsMessage) {
  EXPECT_EQ(message_of(edited(GetParam().from, GetParam().to)), GetParam().message);
}

const WrongFile wrong_files[] = {
    {"schema = \"snare-experiment/1\"\n", "", "x.toml: schema, missing, must be \"snare-experiment/1\""},
    {"length_mm = 180.0\n", "", "x.toml:4: wire.length_mm, missing, must be a number > 0 and <= 100000"},
    {"span_mm = 175.0\n", "", "x.toml:12: mount.span_mm, missing, must be a number > 0 and <= 100000"},
    {"contact_position_mm = 40.0\n", "",
     "x.toml:22: series[s40].contact_position_mm, missing, must be a number > 0 and <= 100000"},
    {"name = \"s40\"\n", "", "x.toml:22: series[1].name, missing, must be a text in quotes"},
    {"points = 21\n", "", "x.toml:22: series[s40].points, missing, must be an integer >= 2 and <= 1000000"},
    {"R2 = 0.998, ", "", "x.toml:31: series[s65].law.R2, missing, must be a number > 0 and <= 1"},
    {"[pusher]\nshape = \"cylinder\"\nradius_mm = 6.0\nfriction = 0.0\ndirection = \"outward\"\n", "",
     "x.toml: pusher, missing, must be a table"},
    {"travel_mm = 2.0\npoints = 21\n", "",
     "x.toml:22: series[s40], must have one of: file, law, travel_mm with points, path_mm with points"},
    {"\"snare-experiment/1\"", "\"snare-experiment/2\"",
     "x.toml:1: schema = \"snare-experiment/2\", must be \"snare-experiment/1\""},
    {"title = \"a loose wire\"", "title = 7", "x.toml:2: title = 7, must be a text in quotes"},
    {"length_mm = 180.0", "length_mm = \"180\"",
     "x.toml:7: wire.length_mm = \"180\", must be a number > 0 and <= 100000"},
    {"length_mm = 180.0", "length_mm = true",
     "x.toml:7: wire.length_mm = true, must be a number > 0 and <= 100000"},
    {"length_mm = 180.0", "length_mm = [180.0]",
     "x.toml:7: wire.length_mm = [180.0], must be a number > 0 and <= 100000"},
    {"length_mm = 180.0", "length_mm = 2026-01-02",
     "x.toml:7: wire.length_mm = 2026-01-02, must be a number > 0 and <= 100000"},
    {"kind = \"clamped\"", "kind = \"glued\"",
     "x.toml:13: mount.kind = \"glued\", must be \"clamped\", \"pinned\" or \"supports\""},
    {"kind = \"clamped\"", "kind = 1",
     "x.toml:13: mount.kind = 1, must be \"clamped\", \"pinned\" or \"supports\""},
    {"points = 21", "points = 21.5",
     "x.toml:26: series[s40].points = 21.5, must be an integer >= 2 and <= 1000000"},
    {"[wire]", "[[wire]]", "x.toml:4: wire, must be a table"},
    {"law = { A_N_m2 = 878089.0, B_N_m = -1086.0, C_N = 0.2115, R2 = 0.998, to_mm = 4.0 }", "law = 878089.0",
     "x.toml:31: series[s65].law = 878089.0, must be a table"},
    {"diameter_mm = 1.5", "diameter_mm = -1.5", "x.toml:6: wire.diameter_mm = -1.5, must be > 0 and <= 100"},
    {"diameter_mm = 1.5", "diameter_mm = 0", "x.toml:6: wire.diameter_mm = 0, must be > 0 and <= 100"},
    {"diameter_mm = 1.5", "diameter_mm = 35.0",
     "x.toml:6: wire.diameter_mm = 35.0, must be < 35, a fifth of the span of 175 mm"},
    {"diameter_mm = 1.5", "diameter_mm = 1e-9",
     "x.toml:6: wire.diameter_mm = 1e-9, gives a bending stiffness of 9.47e-39 N m^2, must be >= 1e-15"},
    {"length_mm = 180.0", "length_mm = nan",
     "x.toml:7: wire.length_mm = nan, must be a finite number > 0 and <= 100000"},
    {"length_mm = 180.0", "length_mm = -inf",
     "x.toml:7: wire.length_mm = -inf, must be a finite number > 0 and <= 100000"},
    {"length_mm = 180.0", "length_mm = 1e300", "x.toml:7: wire.length_mm = 1e300, must be > 0 and <= 100000"},
    {"length_mm = 180.0", "length_mm = 173.0",
     "x.toml:7: wire.length_mm = 173.0, must be >= 173.25, 99 % of the span of 175 mm"},
    {"poisson_ratio = 0.29", "poisson_ratio = 0.51",
     "x.toml:9: wire.poisson_ratio = 0.51, must be > -1 and <= 0.5"},
    {"density_kg_m3 = 7930.0", "density_kg_m3 = 7930.0\naxial_stiffness_N = 0.0",
     "x.toml:11: wire.axial_stiffness_N = 0.0, must be > 0 and <= 1e+15"},
    {"friction = 0.0", "friction = 2.5", "x.toml:19: pusher.friction = 2.5, must be >= 0 and <= 2"},
    {"radius_mm = 6.0", "radius_mm = -6.0", "x.toml:18: pusher.radius_mm = -6.0, must be >= 0 and <= 100"},
    {"contact_position_mm = 40.0", "contact_position_mm = 180.0",
     "x.toml:24: series[s40].contact_position_mm = 180.0, must be >= 1.75 and <= 173.25: inside the span of "
     "175 mm, 1 % of it from each mount"},
    {"contact_position_mm = 40.0", "contact_position_mm = 1.0",
     "x.toml:24: series[s40].contact_position_mm = 1.0, must be >= 1.75 and <= 173.25: inside the span of "
     "175 mm, 1 % of it from each mount"},
    {"contact_position_mm = 40.0", "contact_position_mm = 40.0\ncontact_position_sigma_mm = -0.1",
     "x.toml:25: series[s40].contact_position_sigma_mm = -0.1, must be >= 0 and <= 10"},
    {"contact_position_mm = 40.0", "contact_position_mm = 40.0\nforce_sigma_N = 0.0",
     "x.toml:25: series[s40].force_sigma_N = 0.0, must be > 0 and <= 1e+09"},
    {"travel_mm = 2.0", "travel_mm = 0.0", "x.toml:25: series[s40].travel_mm = 0.0, must be > 0 and <= 1000"},
    {"points = 21", "points = 1",
     "x.toml:26: series[s40].points = 1, must be an integer >= 2 and <= 1000000"},
    {"travel_mm = 2.0", "path_mm = [0, 2.0, 2.0]",
     "x.toml:25: series[s40].path_mm = [0, 2.0, 2.0], neighbouring turning points must differ"},
    {"travel_mm = 2.0", "path_mm = [0, \"2.0\"]",
     "x.toml:25: series[s40].path_mm[2] = \"2.0\", must be a number >= -1000 and <= 1000"},
    {"travel_mm = 2.0", "path_mm = [0]",
     "x.toml:25: series[s40].path_mm = [0], must be an array of 2 to 10000 numbers"},
    {"travel_mm = 2.0\npoints = 21", "path_mm = [0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0]\npoints = 1_000_000",
     "x.toml:26: series[s40].points = 1_000_000, gives 11999989 points on the path, must give at most "
     "10000000"},
    {"heldout = [\"s65\"]", "per_series = [\"wire.length_mm\"]",
     "x.toml:35: fit.per_series[1] = \"wire.length_mm\", is in free, too: it cannot be one number for all "
     "series and "
     "one "
     "for each"},
    {"heldout = [\"s65\"]", "model_tolerance = 2",
     "x.toml:35: fit.model_tolerance = 2, must be >= 0 and <= 0.5"},
    {"R2 = 0.998", "R2 = 0.0", "x.toml:31: series[s65].law.R2 = 0.0, must be > 0 and <= 1"},
    {"title = \"a loose wire\"", "solver = { elements = 65 }",
     "x.toml:2: solver.elements = 65, must be a multiple of 4"},
    {"title = \"a loose wire\"", "solver = { elements = 64.0, extrapolate = \"yes\" }",
     "x.toml:2: solver.elements = 64.0, must be an integer >= 16 and <= 100000\n"
     "x.toml:2: solver.extrapolate = \"yes\", must be true or false"},
    {"title = \"a loose wire\"", "gravity.vector_m_s2 = [0, -9.81]",
     "x.toml:2: gravity.vector_m_s2 = [0, -9.81], must be an array of 3 numbers"},
    {"title = \"a loose wire\"", "bulge = { mode = 5, plane_deg = 181 }",
     "x.toml:2: bulge.mode = 5, must be an integer >= 1 and <= 4\n"
     "x.toml:2: bulge.plane_deg = 181, must be >= -90 and <= 90"},
    {"span_mm = 175.0", "span_mm = 175.0\nsupport_radius_mm = 2.0",
     "x.toml:15: mount.support_radius_mm = 2.0, only for a mount of kind \"supports\""},
    {"kind = \"clamped\"", "kind = \"supports\"",
     "x.toml:12: mount.support_radius_mm, missing, must be a number >= 0 and <= 1000"},
    {"kind = \"clamped\"\nspan_mm = 175.0", "kind = \"supports\"\nspan_mm = 181.0\nsupport_radius_mm = 2.0",
     "x.toml:7: wire.length_mm = 180.0, must be >= 181, the span of the supports"},
    {"kind = \"clamped\"", "kind = \"pinned\"\nrotational_stiffness_Nm_rad = 3.0",
     "x.toml:14: mount.rotational_stiffness_Nm_rad = 3.0, only for a mount of kind \"clamped\""},
    {"kind = \"clamped\"", "kind = \"clamped\"\nslip = \"slides\"",
     "x.toml:14: mount.slip = \"slides\", only beside slip_tension_N"},
    {"kind = \"clamped\"", "kind = \"clamped\"\nslip_tension_N = 3.0\nslip = \"rolls\"",
     "x.toml:15: mount.slip = \"rolls\", must be \"feeds\" or \"slides\""},
    {"kind = \"clamped\"", "kind = \"clamped\"\nslip_tension_N = 3.0\nslip_at = \"top\"",
     "x.toml:15: mount.slip_at = \"top\", must be \"left\", \"right\" or \"both\""},
    {"kind = \"clamped\"", "kind = \"clamped\"\nslip_tension_N = 0.0",
     "x.toml:14: mount.slip_tension_N = 0.0, must be > 0 and <= 1e+09"},
    {"density_kg_m3 = 7930.0", "density_kg_m3 = 7930.0\nstrand_slip_breadth = 1.0",
     "x.toml:11: wire.strand_slip_breadth = 1.0, only beside strand_extra_stiffness_Nm2 and "
     "strand_slip_curvature_1_m"},
    {"density_kg_m3 = 7930.0",
     "density_kg_m3 = 7930.0\nstrand_extra_stiffness_Nm2 = 1e-3\nstrand_slip_curvature_1_m = "
     "0.1\nstrand_slip_breadth "
     "= -1.0",
     "x.toml:13: wire.strand_slip_breadth = -1.0, must be >= 0 and <= 5"},
    {"kind = \"clamped\"", "kind = \"supports\"\nsupport_radius_mm = 2\nslip_tension_N = 3.0",
     "x.toml:15: mount.slip_tension_N = 3.0, only for a mount of kind \"clamped\" or \"pinned\""},
    {"travel_mm = 2.0", "travel_mm = 2.0\nfile = \"s40.csv\"",
     "x.toml:25: series[s40].travel_mm = 2.0, cannot stand beside file\n"
     "x.toml:26: series[s40].file = \"s40.csv\", s40.csv: no such file\n"
     "x.toml:27: series[s40].points = 21, cannot stand beside file"},
    {"travel_mm = 2.0\npoints = 21", "law.A_N_m2 = 1.0\ntravel_mm = 2.0",
     "x.toml:25: series[s40].law.B_N_m, missing, must be a number >= -1e+12 and <= 1e+12\n"
     "x.toml:25: series[s40].law.C_N, missing, must be a number >= -1e+12 and <= 1e+12\n"
     "x.toml:25: series[s40].law.R2, missing, must be a number > 0 and <= 1\n"
     "x.toml:25: series[s40].law.to_mm, missing, must be a number > 0 and <= 1000\n"
     "x.toml:26: series[s40].travel_mm = 2.0, cannot stand beside law"},
    {"points = 21", "points = 21\nmount.span_mm = 30.0",
     "x.toml:24: series[s40].contact_position_mm = 40.0, must be >= 0.3 and <= 29.7: inside the span of 30 "
     "mm, 1 % of it from each mount"},
    {"points = 21", "points = 21\nwire.length_mm = 100.0",
     "x.toml:27: series[s40].wire.length_mm = 100.0, must be >= 173.25, 99 % of the span of 175 mm"},
    {"name = \"s65\"", "name = \"s40\"",
     "x.toml:29: series[s40].name = \"s40\", another series has this name\n"
     "x.toml:35: fit.heldout[1] = \"s65\", must be the name of a series; did you mean s40?"},
    {"name = \"s40\"", "name = \"../s40\"",
     "x.toml:23: series[../s40].name = \"../s40\", must be 1 to 64 letters, digits, '_', '-' or '.', the "
     "first a letter, digit or '_'"},
    {"name = \"s40\"", "name = \"\"",
     "x.toml:23: series[1].name = \"\", must be 1 to 64 letters, digits, '_', '-' or '.', the first a "
     "letter, digit or '_'"},
    {"heldout = [\"s65\"]", "heldout = [\"s66\"]",
     "x.toml:35: fit.heldout[1] = \"s66\", must be the name of a series; did you mean s65?"},
    {"heldout = [\"s65\"]", "heldout = [\"s65\", \"s40\"]",
     "x.toml:35: fit.heldout = [\"s65\", \"s40\"], must leave at least one series to fit"},
    {"heldout = [\"s65\"]", "heldout = [\"s65\", \"s65\"]",
     "x.toml:35: fit.heldout[2] = \"s65\", is there twice"},
    {"heldout = [\"s65\"]", "heldout = \"s65\"",
     "x.toml:35: fit.heldout = \"s65\", must be an array of texts in quotes"},
    {"\"reading.force_gain\"", "\"wire.construction\"",
     "x.toml:34: fit.free[2] = \"wire.construction\", must be a number that can be fitted"},
    {"\"reading.force_gain\"", "\"wire.lenght_mm\"",
     "x.toml:34: fit.free[2] = \"wire.lenght_mm\", must be a number that can be fitted; did you mean "
     "wire.length_mm?"},
    {"density_kg_m3 = 7930.0", "density_kg_m3 = 7930.0\nhardening_ratio = 0.1",
     "x.toml:11: wire.hardening_ratio = 0.1, only beside yield_stress_MPa"},
    {"density_kg_m3 = 7930.0", "density_kg_m3 = 7930.0\nstrand_slip_curvature_1_m = 0.1",
     "x.toml:11: wire.strand_slip_curvature_1_m = 0.1, needs strand_extra_stiffness_Nm2 beside it"},
    {"\"reading.force_gain\"", "3", "x.toml:34: fit.free[2] = 3, must be a text in quotes"},
    {"diameter_mm = 1.5", "diameter_mm = 1e-200\nbending_stiffness_Nm2 = 1.0",
     "x.toml:6: wire.diameter_mm = 1e-200, gives an axial stiffness of 0 N, must be >= 1e-12"},
    {"length_mm = 180.0", "lenght_mm = 180.0",
     "x.toml:4: wire.length_mm, missing, must be a number > 0 and <= 100000\n"
     "x.toml:7: wire.lenght_mm = 180.0, unknown key; did you mean length_mm?"},
    {"[wire]", "[wyre]",
     "x.toml: wire, missing, must be a table\n"
     "x.toml:4: wyre, unknown key; did you mean wire?"},
    {"friction = 0.0", "friction = 0.0\ncolour = \"red\"",
     "x.toml:20: pusher.colour = \"red\", unknown key; known here: compliance_m_N, direction, friction, "
     "misalignment_deg, "
     "radius_mm, shape, tilt_deg"},
    {"friction = 0.0", "friction = 0.0\nspan_mm = 3.0",
     "x.toml:20: pusher.span_mm = 3.0, unknown key; did you mean mount.span_mm?"},
    {"points = 21", "points = 21\nmount.spam_mm = 174.0",
     "x.toml:27: series[s40].mount.spam_mm = 174.0, unknown key; did you mean span_mm?"},
    {"points = 21", "points = 21\nsolver.elements = 64",
     "x.toml:27: series[s40].solver, unknown key; known here: bulge, columns, contact_position_mm, "
     "contact_position_sigma_mm, "
     "file, force_sigma_N, "
     "gravity, law, "
     "mount, name, path_mm, points, pusher, scale, travel_mm, wire"},
    {"length_mm = 180.0",
     "length_mm = ", "x.toml:7: not TOML: Error while parsing key-value pair: expected value, saw '\\n'"},
    {"length_mm = 180.0", "length_mm = 180,0",
     "x.toml:7: not TOML: Error while parsing key-value pair: expected a comment or whitespace, saw ','"},
    {"length_mm = 180.0", "length_mm = 180.0\nlength_mm = 181.0",
     "x.toml:8: not TOML: Error while parsing key-value pair: cannot redefine existing floating-point "
     "'length_mm'"},
    {"[mount]", "[mount", "x.toml:12: not TOML: Error while parsing table header: expected ']', saw '\\n'"},
    {"a loose wire", "a loose \xff wire", "x.toml:2: byte 0xff is not UTF-8"},
    {"title", "a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a",
     "x.toml:2: a key has more than 32 dots"},
    {"diameter_mm = 1.5\nlength_mm = 180.0", "diameter_mm = -1.5\nlength_mm = inf\ncolour = \"red\"",
     "x.toml:6: wire.diameter_mm = -1.5, must be > 0 and <= 100\n"
     "x.toml:7: wire.length_mm = inf, must be a finite number > 0 and <= 100000\n"
     "x.toml:8: wire.colour = \"red\", unknown key; known here: axial_stiffness_N, bending_stiffness_Nm2, "
     "construction, "
     "density_kg_m3, diameter_mm, hardening_ratio, length_mm, natural_curvature_1_m, poisson_ratio, "
     "strand_extra_stiffness_Nm2, strand_slip_breadth, strand_slip_curvature_1_m, torsional_stiffness_Nm2, "
     "yield_stress_MPa, "
     "youngs_modulus_GPa"},
};

INSTANTIATE_TEST_SUITE_P(Table, WrongExperiment, testing::ValuesIn(wrong_files));

}  // namespace
}  // namespace snare::identification
