#include "data/text.h"
#include "import/bytes.h"
#include "import/confine.h"
#include "import/number_arrays.h"
#include "import/readers.h"

#ifdef DCNN_WITH_MATIO
#include <matio.h>
#endif

namespace dcnn {

#ifdef DCNN_WITH_MATIO
namespace {

constexpr int kDeepestStruct = 4;
constexpr std::uint64_t kMostMatColumns = 10000, kMostMatElements = std::uint64_t{1} << 30;
constexpr std::uint64_t kMostTransposed = 16;  // 3 x N is a vector over time

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

/// In the child: rows, columns, length of the name, name, numbers by columns.
void send_variable(const matvar_t& v, const std::string& name,
                   const std::function<void(std::string_view)>& send) {
  if (v.rank != 2 || v.isComplex != 0 || v.data == nullptr || v.data_size <= 0) return;
  const std::uint64_t rows = v.dims[0], columns = v.dims[1];
  if (rows == 0 || columns == 0 || rows > kMostMatElements / columns) return;
  if (v.nbytes / static_cast<std::size_t>(v.data_size) < rows * columns) return;
  std::string record;
  for (const std::uint64_t number : {rows, columns, std::uint64_t{name.size()}}) {
    record.append(reinterpret_cast<const char*>(&number), sizeof(number));
  }
  record += name;
  if (append_numbers(v, rows * columns, &record)) send(record);
}

void walk_variable(matvar_t* v, const std::string& name, int depth,
                   const std::function<void(std::string_view)>& send) {
  if (v == nullptr || depth > kDeepestStruct) return;
  if (v->class_type != MAT_C_STRUCT) return send_variable(*v, name, send);
  if (v->rank != 2 || v->dims[0] * v->dims[1] != 1) return;
  const unsigned count = Mat_VarGetNumberOfFields(v);
  char* const* names = Mat_VarGetStructFieldnames(v);
  for (unsigned k = 0; k < count && names != nullptr; ++k) {
    walk_variable(Mat_VarGetStructFieldByIndex(v, k, 0), name + "." + names[k], depth + 1, send);
  }
}

NumberArray parse_variable(std::string_view record, const std::string& place) {
  Bytes bytes(record, place);
  auto rows = bytes.number<std::uint64_t>(), columns = bytes.number<std::uint64_t>();
  const std::string name(bytes.take(bytes.number<std::uint64_t>()));
  const bool transposed = columns > rows && rows <= kMostTransposed;
  NumberArray array;
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
  for (std::uint64_t k = 0; k < wide; ++k) {
    array.channels.push_back(element_name(name, static_cast<Index>(k), static_cast<Index>(wide)));
  }
  return array;
}

}  // namespace

void read_mat(const std::filesystem::path& path, LogBuilder& builder) {
  const std::string file = path.string();
  std::vector<NumberArray> arrays;
  run_confined(
      [&](const auto& seal, const auto& send) {
        Mat_LogInitFunc("dcnn", [](int, char*) {});
        mat_t* mat = Mat_Open(file.c_str(), MAT_ACC_RDONLY);
        require(mat != nullptr, Exit::kData, "is no MAT file that libmatio can open");
        seal();
        while (matvar_t* variable = Mat_VarReadNext(mat)) {
          walk_variable(variable, variable->name != nullptr ? variable->name : "?", 0, send);
          Mat_VarFree(variable);
        }
      },
      [&](std::string_view record) { arrays.push_back(parse_variable(record, file)); }, file);
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
