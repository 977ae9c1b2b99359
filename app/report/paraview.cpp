#include "app/report/paraview.hpp"

#include "base/files.hpp"

#include <fmt/format.h>

namespace snare::app {

namespace {

std::string polydata(const std::vector<Eigen::Matrix3Xd>& polylines) {
  std::string points, connectivity, offsets;
  Eigen::Index count = 0;
  for (const Eigen::Matrix3Xd& line : polylines) {
    for (Eigen::Index i = 0; i < line.cols(); ++i) {
      points += fmt::format("{:.9g} {:.9g} {:.9g}\n", line(0, i), line(1, i), line(2, i));
      connectivity += fmt::format("{} ", count++);
    }
    offsets += fmt::format("{} ", count);
  }
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
      "byte_order=\"LittleEndian\">\n<PolyData>\n"
      "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"0\">\n"
      "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" "
      "format=\"ascii\">\n{}</DataArray></Points>\n"
      "<Lines><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">{}</DataArray>"
      "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">{}</DataArray></Lines>\n"
      "</Piece>\n</PolyData>\n</VTKFile>\n",
      count, polylines.size(), points, connectivity, offsets);
}

}  // namespace

void write_paraview(const std::filesystem::path& folder, const std::string& name,
                    const std::vector<ParaviewFrame>& frames) {
  std::string list;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const std::string file = fmt::format("{}_{:05}.vtp", name, k);
    base::write_text(folder / file, polydata(frames[k].polylines));
    list += fmt::format("<DataSet timestep=\"{:.9g}\" part=\"0\" file=\"{}\"/>\n", frames[k].time, file);
  }
  base::write_text(
      folder / (name + ".pvd"),
      fmt::format("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n{}"
                  "</Collection>\n</VTKFile>\n",
                  list));
}

}  // namespace snare::app
