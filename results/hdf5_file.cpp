#include "results/hdf5_file.hpp"

#include "base/files.hpp"
#include "base/sha256.hpp"

#include <fmt/format.h>

#include <dlfcn.h>
#include <hdf5.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <mutex>
#include <stdexcept>
#include <string_view>
#include <system_error>

// Constants of the header first call the library, by symbols that a program must be linked with; it is open
// before they are used here.
#undef H5CHECK
#define H5CHECK
#undef H5OPEN
#define H5OPEN

namespace snare::results {

namespace {

/// The calls of the HDF5 library that are made here, looked up when they are wanted first. The variables
/// behind its constants (H5T_NATIVE_DOUBLE, H5P_DATASET_CREATE) are looked up by name, too.
class Api {
  void* library_ =
      ::dlopen(SNARE_HDF5_LIBRARY, RTLD_NOW | RTLD_LOCAL);  // before those that are looked up in it

 public:
  static const Api& get() {
    static const Api one;
    return one;
  }

// NOLINTNEXTLINE(bugprone-macro-parentheses): the name of a variable stands in none.
#define SNARE_HDF5(name) decltype(&::name) name = symbol<decltype(&::name)>(#name)
  SNARE_HDF5(H5open);
  SNARE_HDF5(H5dont_atexit);
  SNARE_HDF5(H5Eset_auto2);
  SNARE_HDF5(H5Eget_auto2);
  SNARE_HDF5(H5Ewalk2);
  SNARE_HDF5(H5Fcreate);
  SNARE_HDF5(H5Fopen);
  SNARE_HDF5(H5Fset_libver_bounds);
  SNARE_HDF5(H5Fflush);
  SNARE_HDF5(H5Fclose);
  SNARE_HDF5(H5Gcreate2);
  SNARE_HDF5(H5Gclose);
  SNARE_HDF5(H5Dcreate2);
  SNARE_HDF5(H5Dwrite);
  SNARE_HDF5(H5Dclose);
  SNARE_HDF5(H5Acreate2);
  SNARE_HDF5(H5Aopen);
  SNARE_HDF5(H5Aget_type);
  SNARE_HDF5(H5Awrite);
  SNARE_HDF5(H5Aread);
  SNARE_HDF5(H5Aclose);
  SNARE_HDF5(H5Screate);
  SNARE_HDF5(H5Screate_simple);
  SNARE_HDF5(H5Sclose);
  SNARE_HDF5(H5Tcopy);
  SNARE_HDF5(H5Tset_size);
  SNARE_HDF5(H5Tset_cset);
  SNARE_HDF5(H5Tset_strpad);
  SNARE_HDF5(H5Tis_variable_str);
  SNARE_HDF5(H5Tclose);
  SNARE_HDF5(H5Pcreate);
  SNARE_HDF5(H5Pclose);
  SNARE_HDF5(H5Pset_chunk);
  SNARE_HDF5(H5Pset_deflate);
  SNARE_HDF5(H5Pset_shuffle);
  SNARE_HDF5(H5Pset_istore_k);
  SNARE_HDF5(H5Pset_userblock);
  SNARE_HDF5(H5Pset_obj_track_times);
  SNARE_HDF5(H5Pset_libver_bounds);
  SNARE_HDF5(H5Pset_file_locking);
  SNARE_HDF5(H5Pset_create_intermediate_group);
  SNARE_HDF5(H5free_memory);
#undef SNARE_HDF5

  /// A type or a class of properties: "H5T_NATIVE_DOUBLE_g". The library must have been opened.
  [[nodiscard]] hid_t constant(const char* name) const {
    return *symbol<const hid_t*>(name);
  }

 private:
  Api() {
    H5dont_atexit();  // a file that a full disk left open is not written again at the end of the process
    if (H5open() < 0) throw std::runtime_error("the HDF5 library " SNARE_HDF5_LIBRARY " does not start");
  }

  template <class Symbol>
  [[nodiscard]] Symbol symbol(const char* name) const {
    if (library_ == nullptr) {
      throw std::runtime_error(
          fmt::format("histories need the HDF5 library (Debian: libhdf5-103-1), which cannot be opened: {}",
                      ::dlerror()));
    }
    void* found = ::dlsym(library_, name);
    if (found == nullptr) throw std::runtime_error(fmt::format("{} has no {}", SNARE_HDF5_LIBRARY, name));
    return reinterpret_cast<Symbol>(found);
  }
};

std::mutex& library_mutex() {
  static auto* one = new std::mutex;  // outlives every thread
  return *one;
}

/// While it lives the library prints no errors; before, and after, it does as its other users have said.
class Quiet {
 public:
  Quiet() {
    Api::get().H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    Api::get().H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Quiet() { Api::get().H5Eset_auto2(H5E_DEFAULT, print_, data_); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

/// What the library says of its last failure: the system's words where it has some, else where it failed.
std::string reason() {
  std::string said;
  const auto note = [](unsigned, const H5E_error2_t* error, void* to) -> herr_t {
    auto& words = *static_cast<std::string*>(to);
    const std::string_view text = error->desc != nullptr ? error->desc : "";
    constexpr std::string_view before = "error message = '";
    const std::size_t at = text.find(before);
    if (at != std::string_view::npos) {
      const std::size_t begin = at + before.size();
      words = text.substr(begin, text.find('\'', begin) - begin);
      return 1;
    }
    if (words.empty()) words = text;
    return 0;
  };
  Api::get().H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, note, &said);
  return said.empty() ? "the HDF5 library refuses" : said;
}

/// An object of the library, which closes it when it goes.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close closed_by) : id_(id), close_(closed_by) {
    if (id_ < 0) throw std::runtime_error(reason());
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle& operator=(Handle&&) = delete;
  operator hid_t() const noexcept { return id_; }

  /// Closes it and looks whether that went well: a dataset is written when it is closed.
  void close() {
    if (close_(std::exchange(id_, -1)) < 0) throw std::runtime_error(reason());
  }

 private:
  hid_t id_;
  Close close_;
};

void check(herr_t status) {
  if (status < 0) throw std::runtime_error(reason());
}

constexpr std::size_t rows_of_chunk = 16384;
constexpr unsigned effort = 4;  // of the compression, 1 to 9
/// Half the chunks of a node of their tree: histories have few, and a node is stored whole.
constexpr unsigned tree_of_chunks = 4;

Handle properties(const char* of) {
  const Api& api = Api::get();
  return {api.H5Pcreate(api.constant(of)), api.H5Pclose};
}

/// Of files, groups and datasets alike: when they were made is not kept.
Handle timeless(const char* of) {
  Handle p = properties(of);
  check(Api::get().H5Pset_obj_track_times(p, 0));
  return p;
}

/// Text in UTF-8; size: bytes, H5T_VARIABLE: as many as there are.
Handle text_type(std::size_t size) {
  const Api& api = Api::get();
  Handle type(api.H5Tcopy(api.constant("H5T_C_S1_g")), api.H5Tclose);
  check(api.H5Tset_size(type, size));
  check(api.H5Tset_cset(type, H5T_CSET_UTF8));
  if (size != H5T_VARIABLE) check(api.H5Tset_strpad(type, H5T_STR_NULLPAD));
  return type;
}

Handle space_of(std::size_t size) {
  const Api& api = Api::get();
  const hsize_t extent = size;
  return {api.H5Screate_simple(1, &extent, nullptr), api.H5Sclose};
}

void write_attribute(hid_t object, const std::string& name, hid_t type, hid_t memory, const Handle& space,
                     const void* from) {
  const Api& api = Api::get();
  Handle attribute(api.H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), api.H5Aclose);
  check(api.H5Awrite(attribute, memory, from));
  attribute.close();
}

void write_attributes(hid_t object, const Hdf5Attributes& attributes) {
  const Api& api = Api::get();
  const Handle one(api.H5Screate(H5S_SCALAR), api.H5Sclose);
  for (const auto& [name, value] : attributes) {
    if (const auto* text = std::get_if<std::string>(&value)) {
      const Handle type = text_type(H5T_VARIABLE);
      const char* from = text->c_str();
      write_attribute(object, name, type, type, one, &from);
    } else if (const auto* whole = std::get_if<std::int64_t>(&value)) {
      write_attribute(object, name, api.constant("H5T_STD_I64LE_g"), api.constant("H5T_NATIVE_INT64_g"), one,
                      whole);
    } else if (const auto* number = std::get_if<double>(&value)) {
      write_attribute(object, name, api.constant("H5T_IEEE_F64LE_g"), api.constant("H5T_NATIVE_DOUBLE_g"),
                      one, number);
    } else {
      const auto& texts = std::get<std::vector<std::string>>(value);
      std::vector<const char*> from;
      for (const std::string& one_text : texts) from.push_back(one_text.c_str());
      const Handle type = text_type(H5T_VARIABLE);
      write_attribute(object, name, type, type, space_of(texts.size()), from.data());
    }
  }
}

void write_dataset(hid_t file, const std::string& path, std::size_t size, hid_t type, hid_t memory,
                   const void* from, const Hdf5Attributes& attributes) {
  const Api& api = Api::get();
  const Handle made = timeless("H5P_CLS_DATASET_CREATE_ID_g");
  if (size > 0) {
    const hsize_t chunk = std::min(size, rows_of_chunk);
    check(api.H5Pset_chunk(made, 1, &chunk));
    check(api.H5Pset_shuffle(made));
    check(api.H5Pset_deflate(made, effort));
  }
  const Handle link = properties("H5P_CLS_LINK_CREATE_ID_g");
  check(api.H5Pset_create_intermediate_group(link, 1));
  Handle dataset(api.H5Dcreate2(file, path.c_str(), type, space_of(size), link, made, H5P_DEFAULT),
                 api.H5Dclose);
  if (size > 0) check(api.H5Dwrite(dataset, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, from));
  write_attributes(dataset, attributes);
  dataset.close();
}

constexpr hsize_t seal_size = 512;  // the least block that HDF5 leaves to its users [byte]

/// Throws std::system_error when the file cannot be closed as it should.
void close(base::FileHandle file) {
  if (std::fclose(file.release()) != 0)
    throw std::system_error(errno, std::generic_category(), "its checksum");
}

/// What the seal of a file must be: SHA-256 over its bytes after the seal, chained over chunks of a megabyte.
std::string seal_of(const std::filesystem::path& file) {
  constexpr std::size_t chunk_size = 1 << 20;
  base::InputFile opened = base::open_input(file);
  if (std::fseek(opened.handle.get(), seal_size, SEEK_SET) != 0) return "";
  std::string digest, chunk;
  do {
    chunk.resize(chunk_size);
    chunk.resize(base::read_bytes(opened.handle.get(), chunk.data(), chunk_size, file));
    digest = base::sha256(digest + chunk);
  } while (chunk.size() == chunk_size);
  close(std::move(opened.handle));
  return "snare seal sha256 " + digest + "\n";
}

/// Puts the seal into the bytes that HDF5 leaves to its users.
void seal(const std::filesystem::path& file) {
  const std::string text = seal_of(file);
  base::FileHandle opened(std::fopen(file.c_str(), "r+b"));
  if (!opened || std::fwrite(text.data(), 1, text.size(), opened.get()) != text.size() ||
      std::fflush(opened.get()) != 0)
    throw std::system_error(errno, std::generic_category(), "its checksum");
  close(std::move(opened));
}

}  // namespace

bool is_whole_hdf5(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file)) return false;
  const std::string wanted = seal_of(file);
  const base::InputFile opened = base::open_input(file);
  std::string found(wanted.size(), '\0');
  found.resize(base::read_bytes(opened.handle.get(), found.data(), found.size(), file));
  return found == wanted;
}

struct Hdf5Writer::Library {
  std::filesystem::path path, shown;
  std::unique_lock<std::mutex> held{library_mutex()};
  Quiet quiet;
  std::optional<Handle> file;

  /// Calls something that writes; its failure with the name of the file.
  template <class Write>
  void named(const Write& write) {
    try {
      write();
    } catch (const std::exception& error) {
      throw std::runtime_error(fmt::format("{}: cannot be written: {}", shown.string(), error.what()));
    }
  }
};

void require_hdf5() {
  static_cast<void>(Api::get());
}

Hdf5Writer::Hdf5Writer(const std::filesystem::path& file, std::filesystem::path shown) {
  const Api& api = Api::get();
  library_ = std::make_unique<Library>();
  library_->path = file;
  library_->shown = std::move(shown);
  library_->named([&] {
    const Handle access = properties("H5P_CLS_FILE_ACCESS_ID_g");
    // The root group is one of the first format, as that of the later one keeps its times whatever is asked
    // (1.10).
    check(api.H5Pset_libver_bounds(access, H5F_LIBVER_EARLIEST, H5F_LIBVER_V18));
    // File systems of clusters may have no locks; ours is that of the folder.
    check(api.H5Pset_file_locking(access, 0, 1));
    const Handle made = timeless("H5P_CLS_FILE_CREATE_ID_g");
    check(api.H5Pset_istore_k(made, tree_of_chunks));
    check(api.H5Pset_userblock(made, seal_size));
    library_->file.emplace(api.H5Fcreate(file.c_str(), H5F_ACC_TRUNC, made, access), api.H5Fclose);
    // Groups in it are of the kind that needs no room while they are small; every reader since 2008 knows
    // them.
    check(api.H5Fset_libver_bounds(*library_->file, H5F_LIBVER_V18, H5F_LIBVER_V18));
  });
}

Hdf5Writer::~Hdf5Writer() = default;

void Hdf5Writer::attributes(const Hdf5Attributes& attributes) {
  library_->named([&] { write_attributes(*library_->file, attributes); });
}

void Hdf5Writer::group(const std::string& path, const Hdf5Attributes& attributes) {
  const Api& api = Api::get();
  library_->named([&] {
    const Handle made = timeless("H5P_CLS_GROUP_CREATE_ID_g");
    Handle group(api.H5Gcreate2(*library_->file, path.c_str(), H5P_DEFAULT, made, H5P_DEFAULT), api.H5Gclose);
    write_attributes(group, attributes);
    group.close();
  });
}

void Hdf5Writer::dataset(const std::string& path, const std::vector<double>& numbers,
                         const Hdf5Attributes& attributes) {
  const Api& api = Api::get();
  library_->named([&] {
    write_dataset(*library_->file, path, numbers.size(), api.constant("H5T_IEEE_F64LE_g"),
                  api.constant("H5T_NATIVE_DOUBLE_g"), numbers.data(), attributes);
  });
}

void Hdf5Writer::dataset(const std::string& path, const std::vector<std::string>& texts,
                         const Hdf5Attributes& attributes) {
  // Of equal length, which compresses; zero bytes after the end are no part of the text.
  std::size_t longest = 1;
  for (const std::string& text : texts) longest = std::max(longest, text.size());
  std::string all;
  for (const std::string& text : texts) all += text + std::string(longest - text.size(), '\0');
  library_->named([&] {
    const Handle type = text_type(longest);
    write_dataset(*library_->file, path, texts.size(), type, type, all.data(), attributes);
  });
}

void Hdf5Writer::close() {
  library_->named([&] {
    check(Api::get().H5Fflush(*library_->file, H5F_SCOPE_LOCAL));
    library_->file->close();
    seal(library_->path);
  });
}

std::optional<std::string> text_attribute(const std::filesystem::path& file, const std::string& name) {
  const Api& api = Api::get();
  const std::scoped_lock lock(library_mutex());
  const Quiet quiet;
  try {
    const Handle opened(api.H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), api.H5Fclose);
    const Handle attribute(api.H5Aopen(opened, name.c_str(), H5P_DEFAULT), api.H5Aclose);
    const Handle type(api.H5Aget_type(attribute), api.H5Tclose);
    if (api.H5Tis_variable_str(type) <= 0) return std::nullopt;
    char* text = nullptr;
    check(api.H5Aread(attribute, type, &text));
    std::string read = text != nullptr ? text : "";
    api.H5free_memory(text);
    return read;
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

}  // namespace snare::results
