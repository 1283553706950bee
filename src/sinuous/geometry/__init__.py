"""How much room every point has: meshes in, clearance, gradient and nearest triangle out."""
