/* Which reader reads a file, and the readers for TRI, POLY and OBJ. Whatever a file holds, what comes back is whole, or a message
 * says what is wrong. A part of SWIFT_fileio.h, which includes it at its end. */
#ifndef SWIFT_LEGACY_MESH_FILES_H
#define SWIFT_LEGACY_MESH_FILES_H

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <locale>

#if defined(__unix__) || defined(__APPLE__)
#include <sys/stat.h>
#endif

#include "mesh.h"
#include "messages.h"

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

namespace swift_legacy {

/* What a reader has read so far. Vectors grow with the file, so that a wrong count asks for no memory. */
struct FileMesh {
    std::vector<SWIFT_Real> vertices;
    std::vector<int> corners;
    std::vector<int> valences;

    template <class Value> static Value* new_array(const std::vector<Value>& values)
    {
        Value* array = new Value[values.empty() ? 1 : values.size()];
        std::copy(values.begin(), values.end(), array);
        return array;
    }

    /* Hands the arrays over, all or none. */
    void give(SWIFT_Real*& vs, int*& fs, int& vn, int& fn, int*& fv) const
    {
        vs = new_array(vertices);
        try {
            fs = new_array(corners);
            fv = std::count(valences.begin(), valences.end(), 3) == static_cast<std::ptrdiff_t>(valences.size())
                     ? NULL
                     : new_array(valences);
        } catch (...) {
            delete[] fs;
            delete[] vs;
            vs = NULL, fs = NULL;
            throw;
        }
        vn = static_cast<int>(vertices.size() / 3);
        fn = static_cast<int>(valences.size());
    }
};

/* A word of a file as a whole number; false if it is not one. */
inline bool parse_int(const std::string& word, int& value)
{
    std::istringstream stream(word);
    stream.imbue(std::locale::classic());
    return (stream >> value) && stream.peek() == std::istringstream::traits_type::eof();
}

} // namespace swift_legacy

inline bool SWIFT_Basic_File_Reader::Read(std::ifstream& fin, SWIFT_Real*& vs, int*& fs, int& vn, int& fn, int*& fv)
{
    fin.imbue(std::locale::classic());
    std::string magic;
    fin >> magic;
    const std::string about = "Error (" + magic + " file): ";
    if (magic != "TRI" && magic != "POLY") {
        swift_legacy::report("Error: The file begins with \"" + magic + "\", not with TRI or POLY");
        return false;
    }
    int vertex_count = 0, face_count = 0;
    if (!(fin >> vertex_count >> face_count) || vertex_count <= 0 || face_count <= 0) {
        swift_legacy::report(about + "the numbers of vertices and faces are missing or not positive");
        return false;
    }
    swift_legacy::FileMesh mesh;
    for (int v = 0; v < vertex_count; ++v) {
        SWIFT_Real x, y, z;
        if (!(fin >> x >> y >> z)) {
            swift_legacy::report(about + "vertex " + swift_legacy::text(v) + " is missing or no number");
            return false;
        }
        mesh.vertices.push_back(x), mesh.vertices.push_back(y), mesh.vertices.push_back(z);
    }
    for (int face = 0; face < face_count; ++face) {
        int valence = 3;
        bool is_read = magic == "TRI" || (fin >> valence && valence >= 3);
        for (int corner = 0; is_read && corner < valence; ++corner) {
            int vertex = 0;
            is_read = fin >> vertex && vertex >= 0 && vertex < vertex_count;
            mesh.corners.push_back(vertex);
        }
        if (!is_read) {
            swift_legacy::report(about + "face " + swift_legacy::text(face) + " is missing or has a vertex that there is not");
            return false;
        }
        mesh.valences.push_back(valence);
    }
    mesh.give(vs, fs, vn, fn, fv);
    return true;
}

inline bool SWIFT_Obj_File_Reader::Read(std::ifstream& fin, SWIFT_Real*& vs, int*& fs, int& vn, int& fn, int*& fv)
{
    swift_legacy::FileMesh mesh;
    std::string line;
    for (int number = 1; std::getline(fin, line); ++number) {
        const std::string about = "Error (OBJ file): line " + swift_legacy::text(number) + ": ";
        std::istringstream words(line);
        words.imbue(std::locale::classic());
        std::string word;
        words >> word;
        const int vertex_count = static_cast<int>(mesh.vertices.size() / 3);
        if (word == "v") {
            SWIFT_Real x, y, z;
            if (!(words >> x >> y >> z)) {
                swift_legacy::report(about + "a vertex has fewer than three coordinates");
                return false;
            }
            mesh.vertices.push_back(x), mesh.vertices.push_back(y), mesh.vertices.push_back(z);
        } else if (word == "f") {
            int valence = 0;
            while (words >> word) {
                int vertex = 0;
                bool is_read = swift_legacy::parse_int(word.substr(0, word.find('/')), vertex);
                vertex = vertex < 0 ? vertex_count + vertex : vertex - 1;
                is_read = is_read && vertex >= 0;
                if (!is_read) {
                    swift_legacy::report(about + "\"" + word + "\" is no vertex");
                    return false;
                }
                mesh.corners.push_back(vertex);
                ++valence;
            }
            if (valence < 3) {
                swift_legacy::report(about + "a face has fewer than three corners");
                return false;
            }
            mesh.valences.push_back(valence);
        }
    }
    if (mesh.vertices.empty() || mesh.valences.empty()) {
        swift_legacy::report("Error (OBJ file): there are no vertices or no faces");
        return false;
    }
    const int most = *std::max_element(mesh.corners.begin(), mesh.corners.end());
    if (static_cast<std::size_t>(most) >= mesh.vertices.size() / 3) {
        swift_legacy::report("Error (OBJ file): a face names vertex " + swift_legacy::text(most + 1) + " of " +
                             swift_legacy::text(mesh.vertices.size() / 3));
        return false;
    }
    mesh.give(vs, fs, vn, fn, fv);
    return true;
}

#endif
