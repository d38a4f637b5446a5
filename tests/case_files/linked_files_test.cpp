// Files that a case names: accepted forms of a CSV file of points and messages for bad files. The effective case does
// not need the folder of the original case.
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "case/case_file.h"
#include "case/writer.h"

namespace tailwater {
namespace {

/// A case and a file that it names, in a new folder.
class LinkedFile : public testing::Test {
 protected:
  LinkedFile(const std::string& case_text, const char* name)
      : file_(case_text), linked_(file_.path().parent_path() / name) {}

  void write(const std::string& text) const { std::ofstream(linked_) << text; }

  std::string message(const std::string& text) const {
    write(text);
    try {
      read_case(file_.path());
    } catch (const InputError& error) {
      return error.what();
    }
    ADD_FAILURE() << "no InputError for\n" << text;
    return {};
  }

  CaseFile file_;
  std::filesystem::path linked_;
};

const std::string bed_case = required_keys + water + "[[wall]]\nname = \"bed\"\npoints_file = \"bed.csv\"\n";

class BedFile : public LinkedFile {
 protected:
  BedFile() : LinkedFile(bed_case, "bed.csv") {}

  std::vector<Coordinates> points() const { return read_case(file_.path()).walls[0].points; }
};

TEST_F(BedFile, IsReadWithAnySeparatorHeaderAndUnit) {
  const std::vector<Coordinates> bed{{0.0, 1.5}, {2.5, -0.25}};
  for (const char* text : {
           "0,1.5\n2.5,-0.25\n",
           "# surveyed 2021\n\n0 1.5\r\n  2.5   -0.25\r\n",
           "\xef\xbb\xbfx [m];z [m]\n0;1.5\n+2.5;-2.5e-1\n",
           "\"x_mm\",\"z_cm\"\n0,150\n2500,-25\n",
           "Point\tElevation (m)\tStation (km)\tRemark\nP1\t1.5\t0\tleft bank\nP2\t-0.25\t0.0025\tgate\n",
       }) {
    write(text);
    const std::vector<Coordinates> found = points();
    ASSERT_EQ(found.size(), 2u) << text;
    for (int k = 0; k < 2; ++k) {
      EXPECT_DOUBLE_EQ(found[k][0], bed[k][0]) << text;
      EXPECT_DOUBLE_EQ(found[k][1], bed[k][1]) << text;
    }
  }
}

TEST_F(BedFile, IsRefusedWithPlaceAndRemedy) {
  struct Bad {
    std::string text, line;
    std::vector<std::string> words;
  };
  for (const Bad& bad : {
           Bad{"", "bed.csv:0", {"has no points"}},
           Bad{"# nothing else\n", "bed.csv:1", {"has no points"}},
           Bad{"x,z\n0,1\n1,abc\n", "bed.csv:3", {"\"abc\" is not a number", "correct it"}},
           Bad{"0;1,5\n1;2,5\n", "bed.csv:1", {"\"1,5\" is not a number", "decimals with a point"}},
           Bad{"0,1\n1\n", "bed.csv:2", {"has 1 columns", "complete the line"}},
           Bad{"0,1\n1,nan\n", "bed.csv:2", {"nan is no finite length"}},
           Bad{"0,1\n1,1e999\n", "bed.csv:2", {"is not a number"}},
           Bad{"0,1,2\n", "bed.csv:1", {"has 3 columns and no line that names them"}},
           Bad{"x,y,z\n0,1,2\n", "bed.csv:1", {"2 are named y, z", "name one of each"}},
           Bad{"x [inch], z [m]\n0,1\n", "bed.csv:1", {"unknown unit \"inch\"", "m, mm, cm, km or ft"}},
           Bad{std::string("0,1\n\0\1\2,1\n", 10), "bed.csv:2", {"not a text file"}},
           Bad{"0,1\n", "case.toml:8", {"too few points", "at least 2"}},
           Bad{"x,z\n0,5,1,25\n", "bed.csv:2", {"has 4 columns, and the first line has 2", "decimals", "point"}},
           Bad{"x;z\n0;5;1\n", "bed.csv:2", {"has 3 columns", "name all columns"}},
           Bad{"x z\n0 secret:$6$a\n", "bed.csv:2", {"the entry in column 2 is not a number"}},
       }) {
    const std::string message = this->message(bad.text);
    EXPECT_NE(message.find("case.toml:8:15: wall[0].points_file = \"bed.csv\": "), std::string::npos) << message;
    EXPECT_NE(message.find(bad.line), std::string::npos) << message;
    for (const std::string& word : bad.words) EXPECT_NE(message.find(word), std::string::npos) << message;
  }
  std::filesystem::remove(linked_);
  EXPECT_THROW(read_case(file_.path()), InputError);
}

TEST_F(BedFile, OfManyPointsIsRefused) {
  std::string text;
  for (int k = 0; k <= 10000; ++k) text += fmt::format("{},0\n", k);
  const std::string message = this->message(text);
  EXPECT_NE(message.find("bed.csv:10001"), std::string::npos) << message;
}

TEST_F(BedFile, IsPartOfTheCaseThatARunLeaves) {
  write("x,z\n0.1,1\n0.7,0\n");
  const CaseSpec spec = read_case(file_.path());
  std::filesystem::remove(linked_);
  EXPECT_EQ(read_text(effective_case(spec)), spec);
}

TEST_F(BedFile, AndPointsExcludeEachOther) {
  write("0,0\n1,0\n");
  EXPECT_NE(message_of(bed_case + "points = [[0, 0], [1, 0]]\n").find("has points as well"), std::string::npos);
  EXPECT_NE(message_of(required_keys + water + "[[wall]]\n").find("points_file"), std::string::npos);
}

const std::string mesh_case = "case.dimension = 3\n" + required_keys +
                              "[[fluid]]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n[[wall]]\nshape = \"mesh\"\n"
                              "file = \"pier.stl\"\nfluid_side = \"outside\"\n";

TEST(MeshFile, IsNamedWithItsFolderAndChecksumInTheCaseThatARunLeaves) {
  const CaseFile file(mesh_case);
  const std::filesystem::path mesh = file.path().parent_path() / "pier.stl";
  std::ofstream(mesh) << "123456789";  // the CRC-32 of this text is known
  const CaseSpec spec = read_case(file.path());
  EXPECT_EQ(spec.walls[0].file, mesh.string());
  EXPECT_EQ(spec.walls[0].checksum, "cbf43926");
  const std::string written = effective_case(spec);
  EXPECT_EQ(read_case_text(written, "run"), spec);
  std::ofstream(mesh) << "1234567890";
  try {
    read_case_text(written, "run");
    ADD_FAILURE() << "a changed file was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("has changed"), std::string::npos) << error.what();
  }
}

TEST(MeshFile, NeedsASideAndThreeDimensions) {
  const std::string no_side = mesh_case.substr(0, mesh_case.find("fluid_side"));
  EXPECT_NE(message_of(no_side).find("wall[0].fluid_side is missing"), std::string::npos);
  EXPECT_NE(message_of(no_side + "fluid_side = \"left\"\n").find("\"above\" or \"below\""), std::string::npos);
  EXPECT_NE(message_of(mesh_case.substr(mesh_case.find('\n') + 1)).find("shape of three dimensions"),
            std::string::npos);
  EXPECT_NE(message_of(mesh_case).find("cannot read it"), std::string::npos);
}

const std::string gauge_case = required_keys + water + "[[probe]]\nname = \"H2\"\ntype = \"depth\"\nat = [0, 0]\n" +
                               "[[probe]]\nname = \"p\"\ntype = \"pressure\"\nat = [0, 0]\n" +
                               "[[probe]]\nname = \"line\"\ntype = \"profile\"\nfrom = [0, 0]\nto = [1, 0]\n" +
                               "times = [0.5]\n[[measurement]]\nfile = \"gauge.csv\"\nprobe = ";

/// Measurements of a laboratory.
class GaugeFile : public LinkedFile {
 protected:
  GaugeFile() : LinkedFile(gauge_case + "\"H2\"\n", "gauge.csv") {}

  std::string complaint(const std::string& keys, const std::string& text) const {
    std::ofstream(file_.path()) << gauge_case << keys << "\n";
    return message(text);
  }
};

TEST_F(GaugeFile, IsReadByTheNameOfTheProbeOrOfTheColumnOrAsTheOnlyOne) {
  for (const char* text : {
           "t [s], H2 [mm]\n0, 100\n0.5, 120\n",
           "time_s;H1_m;h2_cm\n0;7;10\n0.5;7;12\n",
           "connected [mm], pressure [Pa], t [ms]\n100, 1, 0\n120, 1, 500\n",
           "# of a figure\nt_s,value_m,tstar,h_over_H\n0.5,0.12,9,9\n0,0.09,9,9\n0,0.11,9,9\n",
           "t depth\n0 0.1\n0.5 0.12\n",
       }) {
    write(text);
    const MeasurementTable found = read_case(file_.path()).measurements[0];
    EXPECT_EQ(found.column, "connected") << text;
    ASSERT_EQ(found.series.time, (std::vector<double>{0.0, 0.5})) << text;
    EXPECT_NEAR(found.series.columns[0][0], 0.1, 1e-15) << text;
    EXPECT_NEAR(found.series.columns[0][1], 0.12, 1e-15) << text;
  }
}

TEST_F(GaugeFile, OfAProfileHasPlacesInTheOrderOfTheFile) {
  std::ofstream(file_.path()) << gauge_case << "\"line\"\n";
  write("t [s], x [cm], connected [mm]\n0.5, 100, 100\n0.5, 0, 120\n");
  const TimeSeries found = read_case(file_.path()).measurements[0].series;
  EXPECT_EQ(found.time, (std::vector<double>{0.5, 0.5}));
  EXPECT_NEAR(found.columns[0][0], 0.1, 1e-15);
  EXPECT_EQ(found.columns[1], (std::vector<double>{1.0, 0.0}));
}

TEST_F(GaugeFile, IsRefusedWithPlaceAndRemedy) {
  struct Bad {
    std::string keys, text;
    std::vector<std::string> words;
  };
  const std::string good = "t [s], H2 [m]\n0, 1\n1, 1\n";
  for (const Bad& bad : {
           Bad{"\"H3\"", good, {"measurement[0].probe = \"H3\"", "case.toml:22:9", "no such probe", "\"H2\""}},
           Bad{"\"line\"",
               "t [s], line [m]\n0, 1\n1, 1\n",
               {"gauge.csv:1", "no column \"x\"", "\"t [s], line [m], x [m]\""}},
           Bad{"\"line\"",
               "t [s], x [m], line [m]\n0.5, 0, 1\n0.6, 0, 1\n",
               {"measurement[0].file", "t = 0.6 s", "takes no profile"}},
           Bad{"\"H2\"\ncolumn = \"hihgest\"", good, {"measurement[0].column", "did you mean \"highest\"?"}},
           Bad{"\"line\"\ncolumn = \"u\"", good, {"measurement[0].column", "no such column"}},
           Bad{"\"H2\"", "t [s], a [m], b [m]\n0, 1, 1\n", {"gauge.csv:1", "no column \"H2\"", "\"t [s], H2 [m]\""}},
           Bad{"\"H2\"", "t [s], H2 [kPa]\n0, 1\n", {"gauge.csv:1", "unknown unit \"kpa\"", "m, mm, cm, km or ft"}},
           Bad{"\"p\"", "t [s], p\n0, 1\n", {"gauge.csv:1", "has no unit", "p [pa]"}},
           Bad{"\"H2\"", "t [s], H2 [m]\n0, 1\n1, x\n", {"gauge.csv:3", "\"x\" is not a number"}},
           Bad{"\"H2\"", "t [s], H2 [m]\n0, 1\n", {"1 lines of numbers", "at least two"}},
           Bad{"\"H2\"", "H2 [m]\n0\n", {"does not name the column t"}},
           Bad{"\"H2\"", "t [s], H2 [m], time [ms]\n0, 1, 0\n", {"gauge.csv:1", "more than one column of time"}},
           Bad{"\"H2\"",
               "t [s], H2 [m]\n-5, 1\n-4, 1\n",
               {"ends at t = -4 s, where the run begins", "shift its times"}},
       }) {
    const std::string message = complaint(bad.keys, bad.text);
    for (const std::string& word : bad.words) EXPECT_NE(message.find(word), std::string::npos) << message;
  }
}

TEST_F(GaugeFile, IsPartOfTheCaseThatARunLeaves) {
  write("t [s], H2 [m]\n0, 1\n1, 1\n");
  const CaseSpec spec = read_case(file_.path());
  EXPECT_EQ(read_case_text(effective_case(spec), "run"), spec);
  write("t [s], H2 [m]\n0, 1\n1, 2\n");
  EXPECT_THROW(read_case_text(effective_case(spec), "run"), InputError);
}

const std::string rolled_case = required_keys + water +
                                "[[wall]]\nname = \"tank\"\npoints = [[0, 2], [0, 0], [1, 0], [1, 2]]\n"
                                "motion = \"roll.csv\"\n";

class MotionFile : public LinkedFile {
 protected:
  MotionFile() : LinkedFile(rolled_case, "roll.csv") {}
};

const std::string inlet_case =
    required_keys + water + "[[inlet]]\nfrom = [0, 0]\nto = [0, 1]\nfile = \"hydrograph.csv\"\n";

class Hydrograph : public LinkedFile {
 protected:
  Hydrograph() : LinkedFile(inlet_case, "hydrograph.csv") {}
};

TEST_F(MotionFile, IsReadWithAnyUnitAndOrderOfColumns) {
  for (const char* text : {
           "t,x,angle [rad]\n-1,0.5,0\n0,0.25,-0.5\n2,0,0.5\n",
           "# encoder 3\nangle [rad]; time [ms]; X [mm]\n0;-1000;500\n\n-0.5;0;250\n5e-1;2000;0\n",
       }) {
    write(text);
    const TimeSeries series = read_case(file_.path()).walls[0].series;
    EXPECT_EQ(series.time, (std::vector<double>{-1.0, 0.0, 2.0})) << text;
    ASSERT_EQ(series.columns.size(), 4u);
    EXPECT_EQ(series.columns[0], (std::vector<double>{0.5, 0.25, 0.0})) << text;
    EXPECT_TRUE(series.columns[1].empty() && series.columns[2].empty()) << text;
    EXPECT_EQ(series.columns[3], (std::vector<double>{0.0, -0.5, 0.5})) << text;
  }
  write("t [min], angle [deg]\n0, 0\n1, 180\n");
  EXPECT_DOUBLE_EQ(read_case(file_.path()).walls[0].series.time.back(), 60.0);
  EXPECT_DOUBLE_EQ(read_case(file_.path()).walls[0].series.columns[3].back(), std::numbers::pi);
}

TEST_F(MotionFile, IsRefusedWithPlaceAndRemedy) {
  struct Bad {
    std::string text, place;
    std::vector<std::string> words;
  };
  for (const Bad& bad : {
           Bad{"", "roll.csv:0", {"has 0 lines", "at least two"}},
           Bad{"t,x\n0,0\n", "roll.csv:2", {"has 1 lines", "at least two"}},
           Bad{"0,0\n1,0\n", "roll.csv:1", {"has numbers", "t [s], x [m], y [m], z [m], angle [rad]"}},
           Bad{"x,y\n0,0\n1,0\n", "roll.csv:1", {"does not name the column t"}},
           Bad{"t\n0\n1\n", "roll.csv:1", {"does not name any column but t"}},
           Bad{"t,x,x\n0,0,0\n1,0,0\n", "roll.csv:1", {"\"x\" twice", "keep one"}},
           Bad{"t,q\n0,0\n1,0\n", "roll.csv:1", {"a column \"q\"", "correct its name"}},
           Bad{"t,x [l]\n0,0\n1,0\n", "roll.csv:1", {"unknown unit \"l\"", "m, mm, cm, km or ft"}},
           Bad{"t [d],x\n0,0\n1,0\n", "roll.csv:1", {"unknown unit \"d\"", "s, ms, min or h"}},
           Bad{"t,angle\n0,0\n1,0\n", "roll.csv:1", {"has no unit", "write angle [rad]"}},
           Bad{"t,x\n0,0\n1,nan\n", "roll.csv:3", {"nan is no finite value"}},
           Bad{"t,x\n0,0\nnan,0\n", "roll.csv:3", {"nan is no finite time"}},
           Bad{"t,x\n0,0\n1,a\n", "roll.csv:3", {"\"a\" is not a number"}},
           Bad{"t,x\n0,0\n1\n", "roll.csv:3", {"has 1 columns"}},
           Bad{"t,x\n0,0\n2,0\n\n1,0\n", "roll.csv:5", {"1 s, is not after that of line 3, 2 s"}},
           Bad{"t,x\n0,0\n0,1\n", "roll.csv:3", {"keep one of two with the same time"}},
           Bad{"t,x\n0.5,0\n2,0\n", "roll.csv:2", {"begins at t = 0.5 s", "add a line for t = 0"}},
           Bad{"t,x\n0,0\n0.9,0\n", "roll.csv:3", {"t = 0.9 s", "the run ends at 1 s", "the last values again"}},
           Bad{"t,x\n0,0,11\n1,0,12\n", "roll.csv:2", {"has 3 columns, and the first line has 2", "decimals"}},
           Bad{"t,z\n0,0\n2,0\n", "roll.csv", {"column z", "case.dimension = 2"}},
       }) {
    const std::string message = this->message(bad.text);
    const std::string key = "case.toml:9:10: wall[0].motion = \"roll.csv\": ";
    EXPECT_NE(message.find(key), std::string::npos) << bad.text << message;
    EXPECT_NE(message.find(bad.place), std::string::npos) << bad.text << message;
    for (const std::string& word : bad.words) EXPECT_NE(message.find(word), std::string::npos) << bad.text << message;
  }
  std::filesystem::remove(linked_);
  EXPECT_THROW(read_case(file_.path()), InputError);
}

TEST_F(MotionFile, MayHaveEmptyColumnsAtItsEnd) {
  write("t,x,,\n0,0,,\n1,0.5,\n");
  EXPECT_EQ(read_case(file_.path()).walls[0].series.columns[0], (std::vector<double>{0.0, 0.5}));
}

/// A user who may name files in a case need not have permission to read them.
TEST_F(MotionFile, IsNotQuotedUnlessItIsOne) {
  for (const char* text : {"root:x:0:0:root:/root:/bin/bash\n", "user,password\nroot,secret\n", "secret [l]\n1\n"}) {
    const std::string message = this->message(text);
    EXPECT_NE(message.find("does not name the column t"), std::string::npos) << message;
    for (const char* word : {"root", "password", "secret"}) EXPECT_EQ(message.find(word), std::string::npos) << message;
  }
}

TEST_F(MotionFile, IsNamedWithItsFolderAndChecksumInTheCaseThatARunLeaves) {
  write("t,x\n0,0\n1,0.5\n");
  const CaseSpec spec = read_case(file_.path());
  EXPECT_EQ(spec.walls[0].motion, linked_.string());
  const std::string written = effective_case(spec);
  EXPECT_EQ(read_case_text(written, "run"), spec);
  write("t,x\n0,0\n1,0.6\n");
  try {
    read_case_text(written, "run");
    ADD_FAILURE() << "a changed file was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("has changed"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("without motion_checksum"), std::string::npos) << error.what();
  }
}

TEST_F(MotionFile, ExcludesOtherMotionsOfTheWall) {
  write("t,x\n0,0\n1,0.5\n");
  const std::string message = message_of(rolled_case + "rotation = \"t\"\n");
  EXPECT_NE(message.find("wall[0].rotation"), std::string::npos) << message;
  EXPECT_NE(message.find("remove one of the two keys"), std::string::npos) << message;
}

TEST_F(Hydrograph, IsReadWithUnits) {
  write("# gauging station\nlevel [cm]; Time (min); Discharge_l/s\n50; 0; 20\n40; 0.5; 35\n");
  const TimeSeries series = read_case(file_.path()).inlets[0].series;
  EXPECT_EQ(series.time, (std::vector<double>{0.0, 30.0}));
  ASSERT_EQ(series.columns.size(), 3u);
  EXPECT_DOUBLE_EQ(series.columns[0].at(1), 0.035);
  EXPECT_TRUE(series.columns[1].empty()) << "no velocity";
  EXPECT_DOUBLE_EQ(series.columns[2].at(0), 0.5);
}

TEST_F(Hydrograph, UnitsMayBeWrittenAsTheyAreSpoken) {
  for (const char* unit : {"m^3/h", "m3/h"}) {
    write(std::string("t [s], discharge [") + unit + "]\n0, 36\n1, 36\n");
    EXPECT_DOUBLE_EQ(read_case(file_.path()).inlets[0].series.columns[0].at(0), 0.01) << unit;
  }
  for (const char* unit : {"l/s", "l/s/m"}) {
    write(std::string("t [s], discharge [") + unit + "]\n0, 10\n1, 10\n");
    EXPECT_DOUBLE_EQ(read_case(file_.path()).inlets[0].series.columns[0].at(0), 0.01) << unit;
  }
}

TEST_F(Hydrograph, IsRefusedWithPlaceAndRemedy) {
  struct Bad {
    std::string text, line;
    std::vector<std::string> words;
  };
  const std::string head = "t [s], discharge [m^3/s]\n";
  for (const Bad& bad : {
           Bad{"0, 1\n1, 2\n", "hydrograph.csv:1", {"columns must be named", "t [s], discharge [m^3/s]"}},
           Bad{"t [s], discharge\n0, 1\n", "hydrograph.csv:1", {"has no unit", "discharge [m^3/s]"}},
           Bad{"t [s], discharge [gal/s]\n0, 1\n", "hydrograph.csv:1", {"unknown unit \"gal/s\"", "l/s"}},
           Bad{head + "0, 1\n", "hydrograph.csv:2", {"at least two"}},
           Bad{head + "0, 1\n2, 1\n1, 1\n", "hydrograph.csv:4", {"is not after that of line 3", "order of time"}},
           Bad{head + "0, 1\n0, 2\n", "hydrograph.csv:3", {"is not after that of line 2", "keep one of two"}},
           Bad{head + "0, nan\n1, 2\n", "hydrograph.csv:2", {"nan is no finite value"}},
           Bad{head + "0,0,11\n1,0,12\n", "hydrograph.csv:2", {"has 3 columns", "decimals", "with a point"}},
           Bad{head + "0, 1\n1\n", "hydrograph.csv:3", {"complete the line"}},
       }) {
    const std::string message = this->message(bad.text);
    EXPECT_NE(message.find("inlet[0].file = \"hydrograph.csv\": "), std::string::npos) << message;
    EXPECT_NE(message.find(bad.line), std::string::npos) << message;
    for (const std::string& word : bad.words) EXPECT_NE(message.find(word), std::string::npos) << message;
  }
}

/// The effective case of a run names the file with its folder and checksum.
TEST_F(Hydrograph, OfTheEffectiveCaseMustNotChange) {
  write("t [s], discharge [l/s]\n0, 20\n1, 30\n");
  const CaseSpec spec = read_case(file_.path());
  EXPECT_EQ(read_case_text(effective_case(spec), "effective"), spec);
  write("t [s], discharge [l/s]\n0, 20\n1, 31\n");
  EXPECT_THROW(read_case_text(effective_case(spec), "effective"), InputError);
}

}  // namespace
}  // namespace tailwater
