// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "data/text.h"
#include "dcnn/core/excerpt.h"
#include "import/bytes.h"
#include "import/confine.h"
#include "import/mat_tags.h"
#include "import/number_arrays.h"
#include "import/readers.h"

#ifdef DCNN_WITH_MATIO
#include <matio.h>
#endif

namespace dcnn {

#ifdef DCNN_WITH_MATIO
namespace {

constexpr int kDeepestStruct = 4;
constexpr std::size_t kFaultWords = 100;  // characters of libmatio's message that are told
constexpr std::uint64_t kMostMatColumns = 10000, kMostMatElements = std::uint64_t{1} << 30;
constexpr std::uint64_t kMostTransposed = 16;  // 3 x N is a vector over time
constexpr std::uint64_t kMostCells = 1000;     // of a cell array

template <class T>
void append_as_doubles(const matvar_t& variable, std::uint64_t count, std::string* out) {
  const T* values = static_cast<const T*>(variable.data);
  for (std::uint64_t k = 0; k < count; ++k) {
    const auto value = static_cast<double>(values[k]);
    out->append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
}

/// False where the variable holds no real numbers.
bool append_numbers(const matvar_t& v, std::uint64_t count, std::string* out) {
  switch (v.class_type) {
    case MAT_C_DOUBLE:
      return append_as_doubles<double>(v, count, out), true;
    case MAT_C_SINGLE:
      return append_as_doubles<float>(v, count, out), true;
    case MAT_C_INT8:
      return append_as_doubles<std::int8_t>(v, count, out), true;
    case MAT_C_UINT8:
      return append_as_doubles<std::uint8_t>(v, count, out), true;
    case MAT_C_INT16:
      return append_as_doubles<std::int16_t>(v, count, out), true;
    case MAT_C_UINT16:
      return append_as_doubles<std::uint16_t>(v, count, out), true;
    case MAT_C_INT32:
      return append_as_doubles<std::int32_t>(v, count, out), true;
    case MAT_C_UINT32:
      return append_as_doubles<std::uint32_t>(v, count, out), true;
    case MAT_C_INT64:
      return append_as_doubles<std::int64_t>(v, count, out), true;
    case MAT_C_UINT64:
      return append_as_doubles<std::uint64_t>(v, count, out), true;
    default:
      return false;
  }
}

/// How the numbers of a variable lie: by columns.
struct MatShape {
  std::uint64_t rows = 0, columns = 0;
  std::uint64_t matrix = 0;    ///< order of the matrices that the samples are; 0: they are none
  std::uint64_t by_pages = 0;  ///< 1: 3 x 3 x N; 0: N x 3 x 3
};

/// Nothing where the variable is no table and no list of matrices.
MatShape shape_of(const matvar_t& v) {
  if (v.rank == 2) return {v.dims[0], v.dims[1]};
  if (v.rank != 3) return {};
  const auto order = [&](std::size_t a, std::size_t b) {
    return v.dims[a] == v.dims[b] && (v.dims[a] == 3 || v.dims[a] == 4) ? v.dims[a] : 0;
  };
  if (const auto n = order(0, 1); n > 0) return {n * n, v.dims[2], n, 1};
  if (const auto n = order(1, 2); n > 0) return {v.dims[0], n * n, n, 0};
  return {};
}

/// In the child: rows, columns, how matrices lie, length of the name, name, numbers by columns; of
/// numbers that are no table zeros and the name.
void send_variable(const matvar_t& v, const std::string& name,
                   const std::function<void(std::string_view)>& send) {
  if (v.data == nullptr || v.data_size <= 0 || v.class_type == MAT_C_CHAR) return;
  MatShape shape = shape_of(v);
  const bool fits = shape.rows > 0 && shape.columns > 0 && v.isComplex == 0 &&
                    shape.rows <= kMostMatElements / shape.columns &&
                    v.nbytes / static_cast<std::size_t>(v.data_size) >= shape.rows * shape.columns;
  if (!fits) shape = {};
  std::string record;
  for (const std::uint64_t number :
       {shape.rows, shape.columns, shape.matrix, shape.by_pages, std::uint64_t{name.size()}}) {
    record.append(reinterpret_cast<const char*>(&number), sizeof(number));
  }
  record += name;
  if (append_numbers(v, shape.rows * shape.columns, &record)) send(record);
}

void walk_variable(matvar_t* v, const std::string& name, int depth,
                   const std::function<void(std::string_view)>& send) {
  if (v == nullptr || depth > kDeepestStruct) return;
  if (v->class_type == MAT_C_CELL) {
    const std::uint64_t cells = v->rank == 2 ? v->dims[0] * v->dims[1] : 0;
    for (std::uint64_t k = 0; k < std::min(cells, kMostCells); ++k) {
      matvar_t* cell = Mat_VarGetCell(v, static_cast<int>(k));
      walk_variable(cell, name + "{" + std::to_string(k + 1) + "}", depth + 1, send);
    }
    return;
  }
  if (v->class_type != MAT_C_STRUCT) return send_variable(*v, name, send);
  if (v->rank != 2 || v->dims[0] * v->dims[1] != 1) return;
  const unsigned count = Mat_VarGetNumberOfFields(v);
  char* const* names = Mat_VarGetStructFieldnames(v);
  for (unsigned k = 0; k < count && names != nullptr; ++k) {
    walk_variable(Mat_VarGetStructFieldByIndex(v, k, 0), name + "." + names[k], depth + 1, send);
  }
}

/// What libmatio could not read, the first of its messages; it goes on with zeros.
std::string& matio_fault() {
  static std::string fault;
  return fault;
}

void keep_fault(int level, char* message) {
  const bool fault = (level & (MATIO_LOG_LEVEL_ERROR | MATIO_LOG_LEVEL_CRITICAL)) != 0 ||
                     std::string_view(message).find("nd-of-file") != std::string_view::npos;
  if (fault && matio_fault().empty()) matio_fault() = message;
}

NumberArray parse_variable(std::string_view record, const std::string& place,
                           std::vector<std::string>* notes) {
  Bytes bytes(record, place);
  const auto rows = bytes.number<std::uint64_t>(), columns = bytes.number<std::uint64_t>();
  const auto matrix = bytes.number<std::uint64_t>(), by_pages = bytes.number<std::uint64_t>();
  const std::string name(bytes.take(bytes.number<std::uint64_t>()));
  NumberArray array;
  if (rows == 0) {
    notes->push_back(shown(name) +
                     " is complex, empty or has more than two dimensions (lists of 3 x 3 and "
                     "4 x 4 matrices may have three): left out");
    return array;
  }
  const bool transposed = matrix > 0 ? by_pages == 1 : columns > rows && rows <= kMostTransposed;
  array.rows = static_cast<Index>(transposed ? columns : rows);
  const std::uint64_t wide = transposed ? rows : columns;
  if (wide > kMostMatColumns) return {};
  array.columns.resize(static_cast<std::size_t>(wide));
  for (std::uint64_t column = 0; column < columns; ++column) {
    for (std::uint64_t row = 0; row < rows; ++row) {
      array.columns[static_cast<std::size_t>(transposed ? row : column)].push_back(
          bytes.number<double>());
    }
  }
  if (matrix > 0) array.channels = matrix_names(name, static_cast<Index>(matrix), true);
  for (std::uint64_t k = 0; k < wide && matrix == 0; ++k) {
    array.channels.push_back(element_name(name, static_cast<Index>(k), static_cast<Index>(wide)));
  }
  return array;
}

}  // namespace

void read_mat(const std::filesystem::path& path, LogBuilder& builder) {
  const std::string file = path.string();
  const bool truncated = builder.options().accept_truncated;
  const MatOutline outline = outline_of_mat(path);
  require(!outline.cut || truncated, Exit::kData, file,
          ": ends in the middle of a variable; --truncated takes those before it");
  if (outline.cut) builder.log().notes.push_back("the last variable is cut off: left out");
  std::vector<NumberArray> arrays;
  run_confined(
      [&](const auto& seal, const auto& send) {
        Mat_LogInitFunc("dcnn", keep_fault);
        mat_t* mat = Mat_Open(file.c_str(), MAT_ACC_RDONLY);
        require(mat != nullptr, Exit::kData, "is no MAT file that libmatio can open");
        seal();
        for (std::uint64_t k = 0; !outline.cut || k < outline.whole; ++k) {
          matvar_t* variable = Mat_VarReadNext(mat);
          if (variable == nullptr) break;
          const std::string name = variable->name != nullptr ? variable->name : "?";
          require(matio_fault().empty() || truncated, Exit::kData, file, ": ", shown(name),
                  " is damaged (libmatio: ", excerpt(matio_fault(), kFaultWords),
                  "); --truncated leaves it out");
          if (matio_fault().empty()) walk_variable(variable, name, 0, send);
          matio_fault().clear();
          Mat_VarFree(variable);
        }
      },
      [&](std::string_view record) {
        arrays.push_back(parse_variable(record, file, &builder.log().notes));
      },
      file);
  require(!arrays.empty(), Exit::kData, file,
          ": holds no arrays of real numbers (tables and timeseries are objects: save their Data)");
  add_number_arrays(arrays, "", builder);
  builder.log().format = "MATLAB file";
}

#else

void read_mat(const std::filesystem::path& path, LogBuilder&) {
  fail(Exit::kData, path.string(),
       ": is a file of MATLAB, which this build was made without; "
       "install libmatio-dev and build again");
}

#endif

}  // namespace dcnn
