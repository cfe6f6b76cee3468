// Tables and limits, with which queries are answered.
using System;
using System.Text;

namespace Strew
{
    /// <summary>A library of tables. Threads, jobs and tasks may share one.</summary>
    public sealed class Library : IDisposable
    {
        private readonly LibraryHandle handle;

        /// <summary>The version of the native library.</summary>
        public static string Version => StrewException.Text(Native.strew_version());

        /// <summary>Opens the built-in tables.</summary>
        /// <param name="folder">A folder of further table files, or null.</param>
        /// <exception cref="StrewException">A file of the folder is no table.</exception>
        public Library(string folder = null)
        {
            StrewException.Check(Native.strew_library_open(folder == null ? null : Utf8(folder), out handle));
        }

        /// <summary>Plans a query, an address or a body of REST, and counts its points.</summary>
        /// <exception cref="StrewException">The query is not valid.</exception>
        public Plan Query(string query)
        {
            StrewException.Check(Native.strew_plan_query(handle, 2, Utf8(query), out PlanHandle plan));
            return new Plan(plan);
        }

        /// <summary>Plans a chunk: the square of the world grid with this size, column and row.</summary>
        /// <param name="query">A query without a region: one text serves all chunks.</param>
        /// <exception cref="StrewException">The query is not valid.</exception>
        public Plan Chunk(string query, double size, long column, long row)
        {
            Code code = Native.strew_plan_chunk(handle, 2, Utf8(query), size, new[] { column, row }, out PlanHandle plan);
            StrewException.Check(code);
            return new Plan(plan);
        }

        /// <summary>Frees the tables. Plans stay valid.</summary>
        public void Dispose() => handle.Dispose();

        internal static byte[] Utf8(string text) => Encoding.UTF8.GetBytes(text + "\0");
    }
}
