/* Which reader reads a file. A part of SWIFT_fileio.h, which includes it at its end. */
#ifndef SWIFT_LEGACY_FILE_DISPATCHER_H
#define SWIFT_LEGACY_FILE_DISPATCHER_H

#include <cctype>

#if defined(__unix__) || defined(__APPLE__)
#include <sys/stat.h>
#endif

#include "mesh.h"

namespace swift_legacy {

inline bool begins_with(const std::string& whole, const std::string& beginning)
{
    return whole.compare(0, beginning.size(), beginning) == 0;
}

/*
 * Whether something bears this name that is no regular file. A FIFO would be waited for, and a device may never end. What is not
 * there at all is for the opening to find.
 */
inline bool is_no_regular_file(const char* filename)
{
#if defined(__unix__) || defined(__APPLE__)
    struct stat about;
    return stat(filename, &about) == 0 && !S_ISREG(about.st_mode);
#else
    static_cast<void>(filename);
    return false;
#endif
}

/* Opens a file to read. The message of old says why that failed. */
inline bool open_file(const char* filename, std::ifstream& stream)
{
    if (filename == NULL) {
        report("Error: Invalid filename given to read file");
        return false;
    }
    if (is_no_regular_file(filename)) {
        report("Error: only regular files are read, not a pipe, a device or a folder \"" + std::string(filename) + "\"");
        return false;
    }
    stream.open(filename, std::ios::in | std::ios::binary);
    if (!stream) {
        report("Error: file could not be opened for reading \"" + std::string(filename) + "\"");
        return false;
    }
    return true;
}

/*
 * The first word of a file, as far as a magic token can be long; the stream stands at the beginning again. SWIFT++'s decomposer
 * puts a NUL before its own, which is no part of it.
 */
inline std::string first_word(std::ifstream& stream)
{
    const std::size_t most = 64;
    std::string word;
    stream >> std::ws;
    if (stream.peek() == 0) {
        stream.get();
    }
    for (int c = stream.peek(); c != std::ifstream::traits_type::eof() && !std::isspace(c) && word.size() < most; c = stream.peek()) {
        word += static_cast<char>(stream.get());
    }
    stream.clear();
    stream.seekg(0);
    return word;
}

/* The readers of the process: what one scene has registered reads the files of all, as it did in SWIFT 1.x. */
inline SWIFT_File_Read_Dispatcher& file_dispatcher()
{
    static SWIFT_File_Read_Dispatcher dispatcher;
    return dispatcher;
}

/* A mesh from the file, before any transform; false after a message. */
inline bool mesh_from_file(const char* filename, Mesh& mesh)
{
    SWIFT_Real* vertices = NULL;
    int* faces = NULL;
    int* valences = NULL;
    int vertex_count = 0, face_count = 0;
    bool is_read = false;
    try {
        is_read = file_dispatcher().Read(filename, vertices, faces, vertex_count, face_count, valences);
        if (is_read) {
            const std::string fault = mesh_from_arrays(vertices, faces, vertex_count, face_count, valences, mesh);
            is_read = fault.empty();
            if (!is_read) {
                report("Error (" + std::string(filename) + "): " + fault);
            }
        }
    } catch (...) {
        delete[] vertices;
        delete[] faces;
        delete[] valences;
        throw;
    }
    delete[] vertices;
    delete[] faces;
    delete[] valences;
    return is_read;
}

} // namespace swift_legacy

inline SWIFT_File_Read_Dispatcher::SWIFT_File_Read_Dispatcher()
{
    basic_.Register_Yourself(*this);
    obj_.Register_Yourself(*this);
}

inline bool SWIFT_File_Read_Dispatcher::Register(const char* magic_number, SWIFT_File_Reader* file_reader)
{
    const std::string magic = magic_number == NULL ? "" : magic_number;
    if (magic.empty() || file_reader == NULL || magic.find_first_of(" \t\n\v\f\r") != std::string::npos) {
        swift_legacy::report("Error (Register_File_Reader): no file reader, or a magic number that is empty or has white space");
        return false;
    }
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const std::string& other = entries_[i].first;
        if (other == magic) {
            swift_legacy::report("Warning (Register_File_Reader): Replacing already registered file reader for magic number: \"" +
                                 magic + "\"");
            entries_[i].second = file_reader;
            return true;
        }
        if (swift_legacy::begins_with(magic, other) || swift_legacy::begins_with(other, magic)) {
            swift_legacy::report("Error (Register_File_Reader): Of the magic numbers \"" + magic + "\" and \"" + other +
                                 "\" one begins with the other");
            return false;
        }
    }
    entries_.push_back(Entry(magic, file_reader));
    return true;
}

inline bool SWIFT_File_Read_Dispatcher::Read(const char* filename, SWIFT_Real*& vs, int*& fs, int& vn, int& fn, int*& fv)
{
    std::ifstream stream;
    if (!swift_legacy::open_file(filename, stream)) {
        return false;
    }
    const std::string word = swift_legacy::first_word(stream);
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        if (swift_legacy::begins_with(word, entries_[i].first)) {
            return entries_[i].second->Read(stream, vs, fs, vn, fn, fv);
        }
    }
    swift_legacy::report("Error (" + std::string(filename) + "): No registered file reader can handle the type: \"" + word + "\"");
    return false;
}

#endif
