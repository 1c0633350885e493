#include <itkGDCMImageIO.h>
#include <itkGDCMSeriesFileNames.h>
#include <itkImageFileWriter.h>
#include <itkImageIOFactory.h>
#include <itkImageSeriesReader.h>
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>
#include <itkObject.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <system_error>
#include <utility>
#include <vector>

#include "batten/error.h"
#include "batten/output.h"
#include "batten/volume/volume_file.h"

namespace batten {

namespace {

namespace fs = std::filesystem;
using FloatImage = itk::Image<float, 3>;
using ByteImage = itk::Image<unsigned char, 3>;

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// The extension in lower case; ".nii.gz" counts as one.
std::string extension_of(const std::string& path) {
  std::string name = fs::path(path).filename().string();
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  if (ends_with(name, ".nii.gz")) return ".nii.gz";
  return fs::path(name).extension().string();
}

/// ITK's reader and writer of a format, without its search for factories.
itk::ImageIOBase::Pointer image_io(const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension == ".nii" || extension == ".nii.gz" || extension == ".hdr")
    return itk::NiftiImageIO::New().GetPointer();
  if (extension == ".nrrd" || extension == ".nhdr") return itk::NrrdImageIO::New().GetPointer();
  if (extension == ".mha" || extension == ".mhd") return itk::MetaImageIO::New().GetPointer();
  throw Error(ErrorCode::UnknownFormat, path +
                                            ": volumes are .nii, .nii.gz, .nrrd, .nhdr, .mha or .mhd files, or "
                                            "folders of DICOM slices");
}

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw Error(ErrorCode::BadFile, path + ": " + why);
}

/// The first line that says something of what ITK says, in our words where its own say little.
std::string reason_of(const itk::ExceptionObject& error) {
  std::string text = error.GetDescription();
  if (text.find("orthonormal") != std::string::npos)
    return "the axes in its header (sform) are not at right angles, or not as long as its voxel sizes (pixdim); "
           "resample "
           "it, or write its header again";
  std::replace(text.begin(), text.end(), '\n', ' ');
  const std::size_t colon = text.rfind("): ");
  return colon == std::string::npos ? text : text.substr(colon + 3);
}

/// Of the file, and for a header with a file of its own the largest of the folder's files beside it.
double bytes_beside(const std::string& path) {
  double bytes = static_cast<double>(fs::file_size(path));
  const std::string extension = extension_of(path);
  if (extension != ".hdr" && extension != ".nhdr" && extension != ".mhd") return bytes;
  std::error_code failed;
  fs::path folder = fs::path(path).parent_path();
  if (folder.empty()) folder = ".";
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    if (entry.is_regular_file(failed)) bytes = std::max(bytes, static_cast<double>(entry.file_size(failed)));
  }
  return bytes;
}

/// The bytes that a gzip file holds.
double unpacked_bytes(const std::string& path) {
  constexpr unsigned kBlock = 1U << 18;
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  if (!file) throw Error(ErrorCode::FileNotReadable, path + ": cannot be opened");
  std::vector<char> block(kBlock);
  double sum = 0.0;
  for (int read = 1; read > 0; sum += read) {
    read = gzread(file.get(), block.data(), kBlock);
    if (read < 0) refuse(path, "the file is cut off or damaged");
  }
  int state = Z_OK;
  gzerror(file.get(), &state);
  if (state != Z_OK) refuse(path, "the file is cut off or damaged");
  return sum;
}

/// The lines "key = value" of a MetaImage's header.
std::map<std::string, std::string> meta_header(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::map<std::string, std::string> header;
  for (std::string line; std::getline(file, line) && header.count("ElementDataFile") == 0;) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    const std::size_t equals = line.find(" = ");
    if (equals != std::string::npos) header[line.substr(0, equals)] = line.substr(equals + 3);
  }
  return header;
}

/// What readers fill up in silence: a file with less than its header says. NRRD's reader tells by itself.
void check_length(const std::string& path, double bytes) {
  constexpr double kNiftiHeader = 352.0;
  const std::string extension = extension_of(path);
  double held = bytes;
  if (extension == ".nii" || extension == ".nii.gz") {
    held = (extension == ".nii" ? static_cast<double>(fs::file_size(path)) : unpacked_bytes(path)) - kNiftiHeader;
  } else if (extension == ".mha" || extension == ".mhd") {
    const auto header = meta_header(path);
    const auto value = [&](const char* key) {
      const auto found = header.find(key);
      return found == header.end() ? std::string() : found->second;
    };
    if (value("CompressedData") == "True") bytes = std::atof(value("CompressedDataSize").c_str());
    const std::string data = value("ElementDataFile");
    std::error_code failed;
    const fs::path beside = data == "LOCAL" ? fs::path(path) : fs::path(path).parent_path() / data;
    const auto size = fs::file_size(beside, failed);
    if (!failed) held = static_cast<double>(size);
  }
  if (held < bytes) refuse(path, "the file is cut off: it holds fewer voxels than its header says");
}

/// Refuses a NIfTI-1 header whose voxel sizes or directions are not finite: VNL ends the whole process for them.
void check_nifti_numbers(const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension != ".nii" && extension != ".nii.gz" && extension != ".hdr") return;
  std::array<unsigned char, 348> header{};
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  const int size = static_cast<int>(header.size());
  if (!file || gzread(file.get(), header.data(), header.size()) != size) return;  // ITK tells
  const auto word = [&](std::size_t at, bool big) {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 4; ++i) bits |= std::uint32_t{header[at + i]} << 8 * (big ? 3 - i : i);
    return bits;
  };
  const bool big = word(0, true) == header.size();
  if (!big && word(0, false) != header.size()) return;
  // The headers' numbers are floats: pixdim, the quaternion with its offset, the rows of the affine map.
  constexpr std::array<std::pair<std::size_t, std::size_t>, 2> kPlaces{{{76, 8}, {256, 18}}};
  for (const auto& [first, count] : kPlaces) {
    for (std::size_t i = 0; i < count; ++i) {
      if (std::isfinite(std::bit_cast<float>(word(first + 4 * i, big)))) continue;
      refuse(path, "the header's number at byte " + std::to_string(first + 4 * i) +
                       " (voxel sizes and directions) is not finite; write the file again");
    }
  }
}

void check_header(const std::string& path, const itk::ImageIOBase& io) {
  // Deflate makes at most 1032 bytes of one.
  constexpr double kMostInflated = 1100.0;
  const unsigned dimensions = io.GetNumberOfDimensions();
  if (dimensions < 3) refuse(path, "an image of " + std::to_string(dimensions) + " dimensions; a volume has three");
  double voxels = 1.0;
  for (unsigned c = 0; c < dimensions; ++c) {
    const auto size = io.GetDimensions(c);
    if (c >= 3 && size != 1)
      refuse(path, "an image of " + std::to_string(dimensions) + " dimensions; extract one volume of it first");
    if (size < 1) refuse(path, "an image without voxels");
    voxels *= static_cast<double>(size);
  }
  if (io.GetNumberOfComponents() != 1)
    refuse(path, "there are " + std::to_string(io.GetNumberOfComponents()) + " numbers a voxel; a volume has one");
  if (voxels > std::numeric_limits<Index>::max())
    throw Error(ErrorCode::TooLarge, path + ": 2^31 voxels or more; crop the volume or make it coarser");
  if (voxels * io.GetComponentSize() > kMostInflated * bytes_beside(path) + 4096.0)
    refuse(path, "the header claims more voxels than the file holds");
  check_length(path, voxels * io.GetComponentSize());
}

/// ITK's world is LPS.
void turn_rows(Eigen::Matrix3d& axes, Eigen::Vector3d& origin) {
  axes.topRows<2>() *= -1.0;
  origin.head<2>() *= -1.0;
}

template <typename Image>
VolumeGrid grid_of(const Image& image) {
  VolumeGrid grid;
  for (unsigned c = 0; c < 3; ++c) {
    grid.size[c] = static_cast<Index>(image.GetLargestPossibleRegion().GetSize(c));
    grid.origin[c] = image.GetOrigin()[c];
    for (unsigned r = 0; r < 3; ++r) grid.axes(r, c) = image.GetDirection()(r, c) * image.GetSpacing()[c];
  }
  turn_rows(grid.axes, grid.origin);
  return grid;
}

template <typename Image>
typename Image::Pointer image_on(const VolumeGrid& grid) {
  Eigen::Matrix3d axes = grid.axes;
  Eigen::Vector3d origin = grid.origin;
  turn_rows(axes, origin);
  auto image = Image::New();
  typename Image::RegionType region;
  typename Image::SpacingType spacing;
  typename Image::PointType start;
  typename Image::DirectionType direction;
  for (unsigned c = 0; c < 3; ++c) {
    region.SetSize(c, static_cast<itk::SizeValueType>(grid.size[c]));
    spacing[c] = grid.spacing(static_cast<int>(c));
    start[c] = origin[c];
    for (unsigned r = 0; r < 3; ++r) direction(r, c) = axes(r, c) / spacing[c];
  }
  image->SetRegions(region);
  image->SetSpacing(spacing);
  image->SetOrigin(start);
  image->SetDirection(direction);
  image->Allocate();
  return image;
}

Volume volume_of(const FloatImage& image) {
  Volume volume;
  volume.grid = grid_of(image);
  const float* values = image.GetBufferPointer();
  volume.values.assign(values, values + volume.grid.count());
  return volume;
}

Volume read_image(const std::string& path) {
  const itk::ImageIOBase::Pointer io = image_io(path);
  check_nifti_numbers(path);
  io->SetFileName(path);
  io->ReadImageInformation();
  check_header(path, *io);
  auto reader = itk::ImageFileReader<FloatImage>::New();
  reader->SetImageIO(io);
  reader->SetFileName(path);
  reader->Update();
  return volume_of(*reader->GetOutput());
}

Volume read_slices(const std::string& folder) {
  auto names = itk::GDCMSeriesFileNames::New();
  names->SetUseSeriesDetails(true);
  names->SetDirectory(folder);
  const auto series = names->GetSeriesUIDs();
  if (series.empty()) refuse(folder, "there are no DICOM slices in this folder");
  if (series.size() > 1)
    refuse(folder,
           "there are " + std::to_string(series.size()) + " DICOM series in this folder; give one a folder each");
  auto reader = itk::ImageSeriesReader<FloatImage>::New();
  reader->SetImageIO(itk::GDCMImageIO::New());
  reader->SetFileNames(names->GetFileNames(series.front()));
  reader->Update();
  return volume_of(*reader->GetOutput());
}

template <typename Image>
void write_image(const std::string& path, const Volume& volume) {
  using Number = typename Image::PixelType;
  const auto image = image_on<Image>(volume.grid);
  std::transform(volume.values.begin(), volume.values.end(), image->GetBufferPointer(), [](float value) {
    if constexpr (std::is_same_v<Number, float>) return value;
    return static_cast<Number>(std::lround(std::clamp(value, 0.0F, 255.0F)));
  });
  auto writer = itk::ImageFileWriter<Image>::New();
  writer->SetInput(image);
  writer->SetImageIO(image_io(path));
  writer->SetFileName(path);
  writer->SetUseCompression(true);
  writer->Update();
}

}  // namespace

Volume read_volume(const std::string& path) {
  std::error_code failed;
  const fs::file_status status = fs::status(path, failed);
  if (!fs::exists(status)) throw Error(ErrorCode::FileNotReadable, path + ": there is no such file or folder");
  itk::Object::GlobalWarningDisplayOff();  // what it warns of, the errors tell
  Volume volume;
  try {
    volume = fs::is_directory(status) ? read_slices(path) : read_image(path);
  } catch (const itk::ExceptionObject& error) {
    refuse(path, "cannot be read: " + reason_of(error));
  }
  try {
    require_volume(volume);
  } catch (const Error& error) {
    throw Error(error.code(), path + ": " + error.what());
  }
  return volume;
}

void write_volume(const std::string& path, const Volume& volume, VoxelType type) {
  require_volume(volume);
  const std::string extension = extension_of(path);
  if (extension == ".hdr" || extension == ".nhdr" || extension == ".mhd")
    throw Error(ErrorCode::UnknownFormat, path + ": pairs of files are not written; take .nii.gz, .nrrd or .mha");
  image_io(path);
  // ITK tells formats by their extensions, which temporary names lack.
  write_atomically(path, [&](const std::string& temporary) {
    const std::string named = temporary + extension;
    try {
      if (type == VoxelType::Byte) {
        write_image<ByteImage>(named, volume);
      } else {
        write_image<FloatImage>(named, volume);
      }
      fs::rename(named, temporary);
    } catch (const itk::ExceptionObject& error) {
      std::error_code ignored;
      fs::remove(named, ignored);
      throw Error(ErrorCode::FileNotWritable, path + ": " + reason_of(error));
    } catch (const fs::filesystem_error& error) {
      throw Error(ErrorCode::FileNotWritable, path + ": " + error.code().message());
    }
  });
}

}  // namespace batten
