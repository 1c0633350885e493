/// \file Volumes in and out: NIfTI, NRRD, MetaImage and folders of DICOM slices, by ITK.
///
/// In the library batten_volumes, which a build may lack (BATTEN_WITH_VOLUMES).
#pragma once
#include <string>

#include "batten/volume/volume.h"

namespace batten {

/// Reads one volume, with its spacing, directions and origin. path: a file .nii, .nii.gz, .hdr, .nrrd, .nhdr, .mha or
/// .mhd, or a folder with the slices of one DICOM series. The header is checked before memory is taken: a volume has
/// three dimensions, or more of which the others have one element, one number a voxel, and no more voxels than the
/// file can hold. Throws Error: FileNotReadable, UnknownFormat, BadFile (naming the file; truncated ones too),
/// TooLarge, NotFinite naming a voxel; in NIfTI files ITK reads numbers that are not finite as 0.
Volume read_volume(const std::string& path);

/// How voxels are stored.
enum class VoxelType {
  Byte,  ///< whole numbers from 0 to 255, for masks
  Float
};

/// Writes a volume whole or not at all. The format follows the extension, as read_volume() has them but DICOM; pairs of
/// files are not written. Throws Error: FileNotWritable, UnknownFormat, and what require_volume() throws.
void write_volume(const std::string& path, const Volume& volume, VoxelType type = VoxelType::Float);

}  // namespace batten
