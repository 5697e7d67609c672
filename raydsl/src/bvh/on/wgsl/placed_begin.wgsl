/// A traversal that has yet to begin.
fn $name(ray: Ray) -> $traversal_type {
    var w = $traversal_type();
    $enter(&w, 0u, ray, ray.t_max);
    return w;
}
