#include "app/report/paraview.hpp"

#include "base/files.hpp"

#include <fmt/format.h>

#include <string_view>

namespace snare::app {

namespace {

/// Texts as VTK's XML has them: their bytes as numbers, each text ended by 0.
std::string as_bytes(std::string_view text) {
  std::string bytes;
  for (const char c : text) bytes += fmt::format("{} ", static_cast<unsigned char>(c));
  return bytes + "0 ";
}

std::string array(const char* type, const char* name, int components, const std::string& values) {
  return fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\">{}</DataArray>\n", type,
      name, components, values);
}

std::string vector(const Eigen::Matrix3Xd& of, Eigen::Index i) {
  if (i >= of.cols()) return "0 0 0\n";
  return fmt::format("{:.9g} {:.9g} {:.9g}\n", of(0, i), of(1, i), of(2, i));
}

std::string scalar(const Eigen::VectorXd& of, Eigen::Index i) {
  return i < of.size() ? fmt::format("{:.9g}\n", of[i]) : "0\n";
}

/// Columns of the points and of the lines, in the order of a file.
struct Columns {
  std::string points, connectivity, offsets, tension, curvature, contact, velocity, kind, number, name;
  Eigen::Index count = 0;

  explicit Columns(const std::vector<ParaviewLine>& lines) {
    for (const ParaviewLine& line : lines) {
      for (Eigen::Index i = 0; i < line.points.cols(); ++i) {
        points += vector(line.points, i);
        velocity += vector(line.velocities, i);
        contact += vector(line.contact_forces, i);
        tension += scalar(line.tensions, i);
        curvature += scalar(line.curvatures, i);
        connectivity += fmt::format("{} ", count++);
      }
      offsets += fmt::format("{} ", count);
      kind += fmt::format("{} ", static_cast<int>(line.kind));
      number += fmt::format("{} ", line.number);
      name += as_bytes(line.name);
    }
  }
};

std::string polydata(const ParaviewFrame& frame) {
  const Columns c(frame.lines);
  std::string text =
      "<?xml version=\"1.0\"?>\n<!-- SI units: coordinates in metres -->\n"
      "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\n<PolyData>\n<FieldData>\n";
  text += fmt::format(
      "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
      "format=\"ascii\">{:.9g}</DataArray>\n",
      frame.time);
  text += fmt::format(
      "<DataArray type=\"String\" Name=\"coordinates_unit\" NumberOfTuples=\"1\" "
      "format=\"ascii\">{}</DataArray>\n",
      as_bytes("m"));
  text += fmt::format(
      "</FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"{}\" "
      "NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<PointData Scalars=\"tension_N\" "
      "Vectors=\"velocity_m_s\">\n",
      c.count, frame.lines.size());
  text += array("Float64", "tension_N", 1, c.tension) + array("Float64", "curvature_1_m", 1, c.curvature) +
          array("Float64", "contact_force_N", 3, c.contact) + array("Float64", "velocity_m_s", 3, c.velocity);
  text += "</PointData>\n<CellData Scalars=\"kind\">\n" + array("Int32", "kind", 1, c.kind) +
          array("Int32", "number", 1, c.number) + array("String", "name", 1, c.name);
  text += "</CellData>\n<Points>\n" + array("Float64", "Points", 3, c.points) + "</Points>\n<Lines>\n" +
          array("Int64", "connectivity", 1, c.connectivity) + array("Int64", "offsets", 1, c.offsets);
  return text + "</Lines>\n</Piece>\n</PolyData>\n</VTKFile>\n";
}

}  // namespace

void write_paraview(const std::filesystem::path& folder, const std::string& name,
                    const std::vector<ParaviewFrame>& frames) {
  std::string list;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const std::string file = fmt::format("{}_{:05}.vtp", name, k);
    base::write_text(folder / file, polydata(frames[k]));
    list += fmt::format("<DataSet timestep=\"{:.9g}\" part=\"0\" file=\"{}\"/>\n", frames[k].time, file);
  }
  base::write_text(
      folder / (name + ".pvd"),
      fmt::format("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n{}"
                  "</Collection>\n</VTKFile>\n",
                  list));
}

}  // namespace snare::app
