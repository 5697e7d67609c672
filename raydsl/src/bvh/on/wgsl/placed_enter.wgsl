/// Goes into what is placed if the ray, as it is seen there, may hit it.
fn $name(w: ptr<function, $traversal_type>, index: u32, ray: Ray, limit: f32) {
    let place = ${places}_at(index);
    if (place.root == ${NONE}u || !$is_finite(ray)) {
        return;
    }
    let root = ${nodes}_at(place.root);
    let s = $slabs(ray, root.min, root.max, place.slack, place.origin);
    $root_count
    let enter = $enter_leave(s, root.min, root.max, ray.t_min, limit);
    if (!(enter.x <= enter.y)) {
        return;
    }
    (*w).levels[(*w).level] = (*w).here;
    (*w).level = (*w).level + 1u;
    (*w).here = TraversalLevel(ray, index, (*w).here.first + place.first, (*w).top);
    (*w).lower = s.lower;
    (*w).upper = s.upper;
    (*w).inverse = s.inverse;
    (*w).nodes[(*w).top] = place.root;
    (*w).enters[(*w).top] = enter.x;
    (*w).top = (*w).top + 1u;
}
