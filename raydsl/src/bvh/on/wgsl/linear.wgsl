fn $name(ray: Ray) -> $result {
    $declare
    if (!$is_finite(ray)) {
        return $give;
    }
    for (var id = 0u; id < params.len_of_$prims; id = id + 1u) {
        $test
    }
    return $give;
}
