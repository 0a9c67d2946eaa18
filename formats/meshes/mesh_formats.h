#pragma once
// The table of mesh formats, and what is found in it. Functions that take `formats` look there.

#include <string>
#include <string_view>
#include <vector>

#include "formats/meshes/common/mesh_format.h"

namespace spillway::formats {

/// All formats, in the order in which the command lists them.
MeshFormats mesh_formats();

/// The one that standard output takes, and that commands hand to each other: Spillway's own stream.
const MeshFormat& own_mesh_stream();

/// Their names, as the command line lists them: "ply", "ply-ascii", "obj", ...
std::vector<std::string> mesh_format_names(MeshFormats formats = mesh_formats());

/// The format that a file of this extension is written in; null if there is none.
const MeshFormat* mesh_format_of_extension(const std::string& path,
                                           MeshFormats formats = mesh_formats());

/// The format to write `path` in: the one called `format_name`, or, if that is empty, the one of
/// the path's extension; own_mesh_stream() for standard output. Throws InvalidArgument that lists
/// what there is if neither names a format.
const MeshFormat& mesh_format(const std::string& path, const std::string& format_name,
                              MeshFormats formats = mesh_formats());

/// The format of a file by its first bytes, 512 or more, or all there are; null if these are not
/// those of a mesh.
const MeshFormat* mesh_format_of_bytes(std::string_view first_bytes,
                                       MeshFormats formats = mesh_formats());

/// The stream that a file which begins so may be, though its first bytes do not tell; null if none.
const MeshFormat* stream_format_that_resembles(std::string_view first_bytes,
                                               MeshFormats formats = mesh_formats());

/// The format that the name alone of a file to be read tells; null if it tells none.
const MeshFormat* mesh_format_of_name(const std::string& path,
                                      MeshFormats formats = mesh_formats());

/// The format in several files that `path` is one of, of a mesh that is there; null if it is none.
const MeshFormat* mesh_format_of_part(const FileSystem& files, const std::string& path,
                                      MeshFormats formats = mesh_formats());

/// The names of the formats that are `chosen`, own_mesh_stream() before the others, without other
/// ways to write them.
std::vector<std::string> names_of_formats(bool (*chosen)(const MeshFormat&),
                                          MeshFormats formats = mesh_formats());

/// The same as a sentence lists them: "spm, ply, vtu or npy", with `last` for "or".
std::string list_of_formats(bool (*chosen)(const MeshFormat&), std::string_view last,
                            MeshFormats formats = mesh_formats());

/// The names of the attributes, of those of a layout, that a format does not hold.
std::vector<std::string> lost_attributes(const MeshFormat& format, const AttributeLayout& layout);

/// What is to be said of a mesh that was written to `path` in a format that rounds its coordinates,
/// or sees them from an origin; empty for others.
std::string rounding_note(const MeshFormat& format, const std::string& path);

}  // namespace spillway::formats
