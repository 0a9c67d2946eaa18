#pragma once
// The table of point formats, and what is found in it. Functions that take `formats` look there.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/points/common/point_format.h"

namespace spillway::formats {

/// All formats, in the order in which the command lists them.
PointFormats point_formats();

/// The one that standard output takes: Spillway's own stream.
const PointFormat& own_point_stream();

/// Their names, as the command line lists them: "las", "laz", "copc", "text", "npy", "ply",
/// "spp".
std::vector<std::string> point_format_names(PointFormats formats = point_formats());

/// Those of them that are written.
std::vector<std::string> written_point_format_names(PointFormats formats = point_formats());

/// The format of that name; null if there is none.
const PointFormat* find_point_format(std::string_view name, PointFormats formats = point_formats());

/// The format of that name. Throws InvalidArgument that lists them otherwise. Which of those that
/// begin as LAS a file has, its header tells, whatever the name says.
const PointFormat& point_format_by_name(std::string_view name,
                                        PointFormats formats = point_formats());

/// The format of a file by its first bytes, 512 or more, or all there are; null if they tell none.
const PointFormat* point_format_of_bytes(std::string_view first_bytes,
                                         PointFormats formats = point_formats());

/// The format of a source that begins as a mesh might, and whose header tells of points; null if it
/// does not. Throws Failure if such a header is damaged.
const PointFormat* point_format_of_header(InputBytes& source,
                                          PointFormats formats = point_formats());

/// The format that the extension of `path` stands for, those of compressed text (.gz, .bz2, .zst,
/// .lz4) included; null for other extensions.
const PointFormat* point_format_of_path(std::string_view path,
                                        PointFormats formats = point_formats());

/// The titles of the formats that are `chosen`, as a sentence lists them: "LAS, text, npy or spp",
/// with `last` for "or".
std::string list_of_points(bool (*chosen)(const PointFormat&), std::string_view last,
                           PointFormats formats = point_formats());

/// For list_of_points().
bool is_written(const PointFormat& format);

/// The extensions of all formats, with the dot: ".las", ".laz", ".txt", ...
std::vector<std::string> point_extensions(PointFormats formats = point_formats());

}  // namespace spillway::formats
