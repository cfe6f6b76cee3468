// What went wrong, in the words of the library.
using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;
using System.Text;

namespace Strew
{
    /// <summary>The result of a call of the library.</summary>
    public enum Code
    {
        Ok = 0,
        InvalidQuery = 1,
        TooManyPoints = 2,
        TooManyRows = 3,
        OtherTable = 4,
        TableUnreadable = 5,
        NoSuchPoint = 6,
        InvalidArgument = 7,
        BufferTooSmall = 8,
        Internal = 9,
    }

    /// <summary>A call that failed. Its message has the field, the value, and what is allowed.</summary>
    public sealed class StrewException : Exception
    {
        /// <summary>The code of the call.</summary>
        public Code Code { get; }

        /// <summary>The kind of problem: invalid-query, too-many-points, …</summary>
        public string Kind { get; }

        /// <summary>The first field that is wrong; empty if there is none.</summary>
        public string Field { get; }

        /// <summary>The value of that field.</summary>
        public string Value { get; }

        /// <summary>What is allowed in its place.</summary>
        public string Allowed { get; }

        /// <summary>Everything that is wrong, as JSON: kind, detail, and a list of errors.</summary>
        public string Document { get; }

        private StrewException(Code code) : base(Text(Native.strew_error_message()))
        {
            Code = code;
            Kind = Text(Native.strew_error_kind());
            Field = Text(Native.strew_error_field());
            Document = Text(Native.strew_error_document());
            Value = Member(Document, "value");
            Allowed = Member(Document, "allowed");
        }

        // The words are those of the thread whose call failed, so they are read at once.
        internal static void Check(Code code)
        {
            if (code != Code.Ok) throw new StrewException(code);
        }

        internal static string Text(IntPtr text)
        {
            var bytes = new List<byte>();
            for (int i = 0; Marshal.ReadByte(text, i) != 0; i++) bytes.Add(Marshal.ReadByte(text, i));
            return Encoding.UTF8.GetString(bytes.ToArray());
        }

        // The first member of this name whose value is a string. Without a JSON library: the document is compact.
        private static string Member(string document, string name)
        {
            string key = "\"" + name + "\":\"";
            int at = document.IndexOf(key, StringComparison.Ordinal);
            if (at < 0) return "";
            var value = new StringBuilder();
            for (int i = at + key.Length; i < document.Length && document[i] != '"'; i++)
            {
                if (document[i] != '\\')
                {
                    value.Append(document[i]);
                    continue;
                }
                i++;
                switch (document[i])
                {
                    case 'n': value.Append('\n'); break;
                    case 't': value.Append('\t'); break;
                    case 'r': value.Append('\r'); break;
                    case 'b': value.Append('\b'); break;
                    case 'f': value.Append('\f'); break;
                    case 'u':
                        value.Append((char)Convert.ToInt32(document.Substring(i + 1, 4), 16));
                        i += 4;
                        break;
                    default: value.Append(document[i]); break;
                }
            }
            return value.ToString();
        }
    }
}
