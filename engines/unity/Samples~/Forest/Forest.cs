// A forest without end: put it on an object, set the mesh and a material with GPU instancing.
using UnityEngine;

namespace Strew.Samples
{
    public sealed class Forest : MonoBehaviour
    {
        public Mesh mesh;
        public Material material;
        public Transform target;
        public string query = "spacing=2&seed=5&attributes=angle,scale&scale_range=0.7,1.3";
        public float side = 32;
        public int reach = 4;

        // The most instances of one call.
        private const int Most = 1023;

        private Library library;
        private Chunks<Matrix4x4[]> chunks;

        private void OnEnable()
        {
            library = new Library();
            chunks = new Chunks<Matrix4x4[]>(side, reach, Make);
        }

        private void OnDisable() => library.Dispose();

        private void Update()
        {
            // Unity is left-handed with y up, so the plane's y is z.
            Vector3 place = target.position;
            chunks.Around(place.x, place.z);
            var parameters = new RenderParams(material);
            foreach (var chunk in chunks.There)
                for (int from = 0; from < chunk.Value.Length; from += Most)
                {
                    int count = Mathf.Min(Most, chunk.Value.Length - from);
                    Graphics.RenderMeshInstanced(parameters, mesh, 0, chunk.Value, count, from);
                }
        }

        // In a task: it calls nothing of the scene.
        private Matrix4x4[] Make(long column, long row)
        {
            using (Plan plan = library.Chunk(query, side, column, row))
            {
                float[] xy = plan.Offsets(out double[] origin);
                double[] angles = plan.Numbers("angle"), scales = plan.Numbers("scale");
                var places = new Matrix4x4[plan.Count];
                for (int i = 0; i < places.Length; i++)
                {
                    var place = new Vector3((float)origin[0] + xy[2 * i], 0, (float)origin[1] + xy[2 * i + 1]);
                    // The angle turns from x to the plane's y, in radians.
                    var turn = Quaternion.AngleAxis(-(float)angles[i] * Mathf.Rad2Deg, Vector3.up);
                    places[i] = Matrix4x4.TRS(place, turn, Vector3.one * (float)scales[i]);
                }
                return places;
            }
        }
    }
}
